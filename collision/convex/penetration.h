#pragma once

#include "collision/convex/convex_distance.h"
#include "collision/convex/convex_set.h"

namespace corridor {

/// How far a convex set b must move to leave a convex set a. Lengths in metres.
struct Penetration {
  /// Bounds of the depth. If b moves by `upper` along the direction, the two sets touch at most. By
  /// less than `lower`, they overlap. Both include all rounding. 0, 0: the sets do not overlap.
  double lower = 0, upper = 0;
  /// The direction of the move, from a to b: unit, rounded.
  Vec3 direction_W = Vec3::Zero();
  /// A common direction of support: b moved by `upper` is on its positive side, a on its negative
  /// one. For the least depth it is `direction_W`.
  Vec3 normal_W = Vec3::Zero();
  /// A point of each set, p_WA − p_WB = depth·direction_W: where the sets touch after the move.
  Vec3 p_WA = Vec3::Zero(), p_WB = Vec3::Zero();
  int rounds = 0;  ///< points that were added to the inner polytope
};

/// Computes the least depth, over all directions, of two convex sets under their maps.
///
/// Guarantee: `lower` ≤ depth ≤ `upper`, in real arithmetic on the given doubles. The bounds differ
/// by at most the share `accuracy` of the depth, 2^-44 of the largest coordinate, or what 500
/// rounds leave on curved surfaces (1e-4 of the depth in tests).
///
/// Method: the depth is the distance of the origin from the boundary of A − B. If only the spheres
/// that sweep the cores overlap, the distance of the cores gives the depth. Else the expanding
/// polytope algorithm (G. van den Bergen, Proximity queries and penetration depth computation on 3D
/// game objects, 2001) grows an inner polytope. Its faces are exact (convex_surface.h), so flat
/// faces and slivers do no harm; its closest face gives `lower`, and the support of A − B along the
/// normal of that face gives `upper`. Cost: some 10 to 100 rounds.
/// @param accuracy  of the depth, relative, ≥ 0.
Penetration penetration(const PosedSet& a, const PosedSet& b, double accuracy = 1e-9);

/// Computes the depth along a direction: how far b must move along it to leave a. Guarantee and
/// method are the same, with the distance of the boundary of A − B along a ray.
/// @param direction  not 0, finite.
/// @throws std::invalid_argument if the direction is 0 or not finite.
Penetration penetrationAlong(const PosedSet& a, const PosedSet& b, const Vec3& direction,
                             double accuracy = 1e-9);

}  // namespace corridor
