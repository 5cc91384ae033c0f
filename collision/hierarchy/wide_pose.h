#pragma once

#include "collision/core/transform.h"
#include "collision/volumes/obb4.h"

namespace corridor {

class WideObbTree;

/// How one wide tree lies relative to another: x_a = s·M·x_b + t between the trees' own coordinates
/// x = (p − origin)·2^-unit.
struct WidePose {
  /// By more than `pad`, as the spheres about the trees' origins tell; then nothing below is told.
  bool apart = false;
  Mat3 m = Mat3::Identity();
  Vec3 t = Vec3::Zero();
  double scale = 1;
  double unitA = 1;     ///< 2^-unit of a
  double shrink = 0;    ///< times a distance in a's frame is at most that in the world
  float leafError = 0;  ///< of a's unit, rounded up: how far a contact's two points may be apart
  Obb4Pose floats;

  /// `pad`: metres by which `apart` shall mean it.
  WidePose(const WideObbTree& a, const Transform& X_WA, const WideObbTree& b, const Transform& X_WB,
           double pad);
};

}  // namespace corridor
