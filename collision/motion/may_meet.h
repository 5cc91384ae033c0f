#pragma once

#include <cmath>

#include "collision/core/swept_sphere.h"
#include "collision/hierarchy/body.h"
#include "collision/hierarchy/box_tree.h"
#include "collision/motion/relative_motion.h"

namespace corridor {

/// Returns the swept sphere of b in the interval of `relative`, as seen from a. It consists of b's
/// bounding sphere and the motion bound of the centre of that sphere.
SweptSphere sweptSphere(const Body& b, const RelativeMotion& relative);

/// Returns a lower bound of the distance of the swept sphere from the axis-aligned box, in metres.
/// Returns 0 if no distance is proved. If the bound exceeds `enough`, the result may be any proved
/// bound above `enough`.
double clearanceBound(const BoundingBox& box, const SweptSphere& sphere, double enough = HUGE_VAL);
/// Returns the same bound for the axis-aligned box of body a.
inline double clearanceBound(const Body& a, const SweptSphere& sphere, double enough = HUGE_VAL) {
  return clearanceBound(a.box(), sphere, enough);
}
/// Returns a lower bound of the distance of two swept spheres, metres. `enough` has the same
/// meaning as for a box. @pre Both spheres are seen from the same frame in the same interval.
double clearanceBound(const SweptSphere& a, const SweptSphere& b, double enough = HUGE_VAL);
/// Reports whether the swept sphere may come nearer to body a than `margin`. `false` is a proof.
inline bool mayMeet(const Body& a, const SweptSphere& sphere, double margin) {
  return !(clearanceBound(a, sphere, margin) > margin);
}

}  // namespace corridor
