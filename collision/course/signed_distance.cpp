#include "collision/course/signed_distance.h"

#include "collision/convex/convex_distance.h"
#include "collision/core/rounding.h"
#include "collision/course/penetration.h"

namespace corridor {

SignedDistance signedDistance(const PosedSet& a, const PosedSet& b, double accuracy) {
  const ConvexDistance apart = convexDistance(a, b);
  // S of `convexDistance` is below this size.
  const double size = a.reach() + a.pose().t.norm() + b.reach() + b.pose().t.norm();
  // The witness points are on the surfaces up to 2^-50·S each, so their distance is below the true
  // distance by at most 2^-49·S.
  if (apart.distance > 0)
    return {apart.distance, apart.lower, roundedUp(apart.distance + 0x1p-48 * size),
            apart.normal_W, apart.p_WA,  apart.p_WB};
  const Penetration depth = penetration(a, b, accuracy);
  // If no depth is proved, the sets may be apart by up to the band within which contact is
  // reported.
  return {-depth.upper,      -depth.upper, depth.lower > 0 ? -depth.lower : 0x1p-44 * size,
          depth.direction_W, depth.p_WA,   depth.p_WB};
}

}  // namespace corridor
