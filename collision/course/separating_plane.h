#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "collision/core/transform.h"

namespace corridor {

/// The relation of the convex hulls of two sets of points. In space, two hulls that lie in one
/// plane never overlap: they are disjoint or touching, because this plane counts as having one hull
/// on each side. In the plane, the same holds for two hulls on one line.
enum class HullRelation {
  disjoint,     ///< they share no point
  touching,     ///< they share points, and a plane (in 2D a line) has one hull on each side
  overlapping,  ///< they share points, and no plane (in 2D no line) has one hull on each side
};

/// The relation of two hulls, with its witness. The relation is exact: it is that of real
/// arithmetic on the given doubles. All other numbers are rounded.
template <int D>
struct SeparatingPlane {
  HullRelation relation = HullRelation::overlapping;
  /// `disjoint` and `touching`: normal·p ≤ offset for all points p of the first set, and normal·q ≥
  /// offset for all points q of the second. If the relation is `disjoint` and `exact` is false,
  /// both inequalities are strict for the stored normal in real arithmetic, and the offset is in
  /// the middle of the gap.
  Eigen::Matrix<double, D, 1> normal = Eigen::Matrix<double, D, 1>::Zero();
  double offset = 0;
  /// `touching` and `overlapping`: a common point.
  Eigen::Matrix<double, D, 1> point = Eigen::Matrix<double, D, 1>::Zero();
  /// The indices of the points that determine the answer, at most D + 2 in both lists together.
  /// `touching` and `overlapping`: the hulls of these points already share the common point.
  std::vector<std::size_t> first, second;
  bool exact = false;  ///< the relation was decided in rational arithmetic
};

/// Finds a plane that separates the convex hulls of two sets of points in space (D = 3), or a line
/// in the plane (D = 2), by linear programming: the variables are the normal, the offset, and the
/// gap that is maximised.
///
/// Method: Seidel's algorithm in double gives a candidate (seidel-inl.h). A plane is proved by the
/// two extreme points along its normal. Overlap is proved by Radon's theorem: D + 2 points have one
/// partition into two sets whose hulls meet. The signs of D + 2 orientations give this partition.
/// If its two sets are the points of the first and of the second set, and no sign is 0, the hulls
/// overlap. What these tests do not decide is decided in rationals, on the few points that
/// determine the answer. Cost: O(n) in the mean for n points, with a constant of (D + 2)!. GJK
/// (convex_distance.h) is faster.
/// @param seed  seed of the random order. It does not change the relation.
/// @throws std::invalid_argument if a set is empty, or a coordinate is not finite.
template <int D>
SeparatingPlane<D> separatingPlane(std::span<const Eigen::Matrix<double, D, 1>> first,
                                   std::span<const Eigen::Matrix<double, D, 1>> second,
                                   std::uint64_t seed = 1);

extern template SeparatingPlane<2> separatingPlane(std::span<const Eigen::Vector2d>,
                                                   std::span<const Eigen::Vector2d>, std::uint64_t);
extern template SeparatingPlane<3> separatingPlane(std::span<const Vec3>, std::span<const Vec3>,
                                                   std::uint64_t);

}  // namespace corridor
