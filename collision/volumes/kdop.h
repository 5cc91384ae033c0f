#pragma once

#include <array>
#include <cstddef>

#include "collision/core/rounding.h"
#include "collision/volumes/obb.h"

namespace corridor {

/// The directions of a k-DOP's K/2 slabs, not of unit length: the axes; then, of 18 and 26, the six
/// diagonals of faces; of 14 and 26, the four of the cube. Entries are −1, 0 or 1.
template <int K>
const std::array<Vec3, K / 2>& slabDirections();

/// A discrete oriented polytope (Klosowski et al., IEEE TVCG 4(1), 1998) in the frame of its mesh:
/// {x : low_i ≤ n_i·x ≤ high_i} for the K/2 directions n_i. Metres times |n_i|.
template <int K>
struct Kdop {
  static_assert(K == 14 || K == 18 || K == 26);
  static constexpr std::size_t kSlabs = K / 2;

  std::array<double, kSlabs> low, high;

  static constexpr bool kOriented = false;
  static Kdop around(const Obb& box, const Content& content);
  Mat3 frameAxes() const { return Mat3::Identity(); }
  double axisDefect() const { return 0; }
  double centerReach() const;
  double radius() const;
};

}  // namespace corridor
