#pragma once

#include "collision/volumes/aabb.h"
#include "collision/volumes/overlap_obb_obb.h"
#include "collision/volumes/volume.h"

namespace corridor {

/// Tests axis-aligned boxes, each in the frame of its own mesh. In the frame of the other mesh,
/// each box is an oriented box, and the relative rotation is the same for all pairs. So this is the
/// test of `obbsSeparated`, with its 15 axes and margins, for boxes whose own axes are the
/// identity.
template <>
class PairTest<Aabb> {
 public:
  PairTest(const VolumeBounds& a, const VolumeBounds& b, const Transform& X_AB, double error)
      : R_(X_AB.m),
        absR_(R_.cwiseAbs()),
        t_(X_AB.t),
        margins_(boxPairMargins(0, a.centerReach, 0, b.centerReach, X_AB)) {
    margins_.absolute += error;
  }

  bool separated(const Aabb& a, const Aabb& b, double pad) const {
    return internal::separated(pair(a, b), a.half, b.half, margins_, pad);
  }
  double distanceBound(const Aabb& a, const Aabb& b) const {
    return internal::boxDistanceBound(pair(a, b), a.half, b.half, margins_);
  }

 private:
  struct Pair {
    const Mat3 &R, &absR;
    Vec3 T;
  };
  Pair pair(const Aabb& a, const Aabb& b) const {
    return {R_, absR_, (R_ * b.center + t_) - a.center};
  }

  Mat3 R_, absR_;
  Vec3 t_;
  BoxPairMargins margins_;
};

}  // namespace corridor
