#pragma once

#include "collision/core/transform.h"
#include "collision/volumes/obb4.h"

namespace corridor {

class Obb4Tree;

/// The pose of a 4-wide OBB tree b relative to another tree a, with bounds of its rounding: x_a =
/// s·M·x_b + t. Here s is `scale`, and x = (p − origin)·2^-unit are the coordinates of a point p in
/// each tree's own frame and unit.
struct Obb4TreePose {
  /// True if the trees are proved to be more than `pad` apart, by the spheres about their origins
  /// or by their root boxes. The other members are then unspecified.
  bool apart = false;
  alignas(32) double columns[4][4];  ///< the columns of M, and t; the last entry of each is unused
  double scale = 1;
  double unitA = 1;   ///< 2^-unit of a
  double shrink = 0;  ///< distances in the world are ≥ shrink × those in a's frame
  /// Error of the pose in a's unit, rounded up: two triangles that touch may appear up to this far
  /// apart under the rounded pose.
  float leafError = 0;
  Obb4Pose floats;

  Mat3 m() const { return Eigen::Map<const Eigen::Matrix<double, 4, 3>>(columns[0]).topRows<3>(); }
  Vec3 t() const { return Eigen::Map<const Vec3>(columns[3]); }

  /// Returns `metres` in the world as a float in a's unit, rounded up. If a distance in a's frame
  /// exceeds the result, the distance in the world exceeds `metres`.
  float inUnitsOfA(double metres) const;

  /// @param pad the distance for `apart`, metres. If `pad` is infinite, `apart` is false.
  Obb4TreePose(const Obb4Tree& a, const Transform& X_WA, const Obb4Tree& b, const Transform& X_WB,
               double pad);
};

}  // namespace corridor
