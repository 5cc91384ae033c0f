#pragma once

#include "collision/convex/convex_set.h"

namespace corridor {

/// The signed distance of two convex sets: their distance if they are apart, minus their least
/// penetration depth if they overlap, and 0 if they touch. Metres.
struct SignedDistance {
  double distance = 0;
  /// Bounds of the signed distance in real arithmetic on the given doubles; they include all
  /// rounding.
  double lower = 0, upper = 0;
  /// The normal, from a to b: unit, rounded. If b moves by −`distance` along the normal, the sets
  /// touch.
  Vec3 normal_W = Vec3::Zero();
  /// A point of each set, with p_WB − p_WA = distance·normal_W. For sets that are apart, these are
  /// the closest points. For sets that overlap, they are the points that touch after the move.
  Vec3 p_WA = Vec3::Zero(), p_WB = Vec3::Zero();
};

/// Computes the signed distance, by `convexDistance` and, for sets in contact, by `penetration`.
/// The guarantees are those of these two functions. For sets that touch without overlap, the normal
/// may be zero.
/// @param accuracy  the relative accuracy of the depth, ≥ 0.
SignedDistance signedDistance(const PosedSet& a, const PosedSet& b, double accuracy = 1e-9);

}  // namespace corridor
