#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "collision/core/rounding.h"
#include "collision/volumes/obb.h"

namespace corridor {

/// Returns the directions of a k-DOP's K/2 slabs. They are not unit vectors. The three coordinate
/// axes come first. K = 18 and K = 26 add the six diagonals of faces of the cube; K = 14 and K = 26
/// add its four space diagonals. Entries are −1, 0 or 1.
template <int K>
const std::array<Vec3, K / 2>& slabDirections();

/// A discrete oriented polytope (Klosowski et al., IEEE TVCG 4(1), 1998) in the frame of its mesh:
/// {x : low_i ≤ n_i·x ≤ high_i} for the K/2 directions n_i. `low` and `high` are in metres times
/// |n_i|.
template <int K>
struct Kdop {
  static_assert(K == 14 || K == 18 || K == 26);
  static constexpr std::size_t kSlabs = K / 2;

  std::array<double, kSlabs> low, high;

  static constexpr bool kOriented = false;
  static Kdop around(const Obb& box, const Content& content);
  /// Returns a k-DOP around both k-DOPs, as tight as one fitted to the contents of both.
  static Kdop merged(const Kdop& a, const Kdop& b) {
    Kdop both;
    for (std::size_t i = 0; i < kSlabs; ++i) {
      both.low[i] = std::min(a.low[i], b.low[i]);
      both.high[i] = std::max(a.high[i], b.high[i]);
    }
    return both;
  }
  Mat3 frameAxes() const { return Mat3::Identity(); }
  double axisDefect() const { return 0; }
  double centerReach() const;
  double radius() const;
  /// Returns the centre of the slabs along the coordinate axes.
  Vec3 ballCenter() const {
    const Vec3 from(low[0], low[1], low[2]), to(high[0], high[1], high[2]);
    return from + 0.5 * (to - from);
  }
};

}  // namespace corridor
