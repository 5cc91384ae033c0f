#pragma once

#include <array>
#include <cstddef>

namespace corridor {

/// A small matrix game in double, by the simplex method. The entries are a_ij = `entry[i][j]`. The
/// row player chooses the weights μ (`rowWeight`), the column player the weights λ
/// (`columnWeight`). All weights are ≥ 0, and the weights of each player have the sum 1. The value
/// of the game is min over λ of max over rows of Σ_j a_ij λ_j = max over μ of min over columns of
/// Σ_i μ_i a_ij.
///
/// Example: a_ij is the distance by which point j is outside half-space i. Then λ gives the point
/// of the hull of all points that is deepest inside the half-spaces. The half-spaces, weighted by
/// μ, add up to a half-space that contains their intersection and is farthest from the points. The
/// results are rounded, so they are candidates, not proofs.
struct MatrixGame {
  static constexpr std::size_t kMost = 10;  ///< the largest number of rows, and of columns

  std::size_t rows = 0, columns = 0;
  std::array<std::array<double, kMost>, kMost> entry;
  std::array<double, kMost> rowWeight, columnWeight;

  /// Sets `rowWeight` and `columnWeight` to the optimal weights of both players, up to rounding.
  /// @pre the entries are finite; `rows` and `columns` are at least 1 and at most `kMost`.
  void solve();
};

}  // namespace corridor
