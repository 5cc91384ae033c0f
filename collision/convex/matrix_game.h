#pragma once

#include <array>
#include <cstddef>

namespace corridor {

/// A small matrix game in double, by the simplex method: the row player chooses weights μ, the
/// column player weights λ (each ≥ 0, of sum 1), and the value is min over λ of max over rows of
/// Σ_j a_ij λ_j = max over μ of min over columns of Σ_i μ_i a_ij.
///
/// If a_ij is how far point j is outside half-space i, then λ gives the point of the hull of all
/// points that is deepest inside the half-spaces. The half-spaces with weights μ add up to one that
/// contains their intersection and is farthest from the points. The results are rounded:
/// candidates.
struct MatrixGame {
  static constexpr std::size_t kMost = 10;

  std::size_t rows = 0, columns = 0;
  std::array<std::array<double, kMost>, kMost> entry;
  std::array<double, kMost> rowWeight, columnWeight;

  /// Finds the weights. @pre entries are finite, rows and columns are at least 1.
  void solve();
};

}  // namespace corridor
