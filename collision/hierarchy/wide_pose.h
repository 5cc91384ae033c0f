#pragma once

#include "collision/core/transform.h"
#include "collision/volumes/obb4.h"

namespace corridor {

class WideObbTree;

/// How one wide tree lies relative to another: x_a = s·M·x_b + t between the trees' own coordinates
/// x = (p − origin)·2^-unit.
struct WidePose {
  /// By more than `pad`, as the spheres about the trees' origins tell, or their root boxes; then
  /// nothing below is told.
  bool apart = false;
  alignas(32) double columns[4][4];  ///< of M, and t; the last of each is nothing
  double scale = 1;
  double unitA = 1;     ///< 2^-unit of a
  double shrink = 0;    ///< times a distance in a's frame is at most that in the world
  float leafError = 0;  ///< of a's unit, rounded up: how far a contact's two points may be apart
  Obb4Pose floats;

  Mat3 m() const { return Eigen::Map<const Eigen::Matrix<double, 4, 3>>(columns[0]).topRows<3>(); }
  Vec3 t() const { return Eigen::Map<const Vec3>(columns[3]); }

  /// Metres of the world as a float of a's unit, rounded up: what a distance in a's frame exceeds
  /// only if that in the world does.
  float limitOf(double metres) const;

  /// `pad`: metres by which `apart` shall mean it; infinite: nothing is apart.
  WidePose(const WideObbTree& a, const Transform& X_WA, const WideObbTree& b, const Transform& X_WB,
           double pad);
};

}  // namespace corridor
