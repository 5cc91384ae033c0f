#pragma once

#include "collision/convex/convex_distance.h"
#include "collision/convex/convex_set.h"

namespace corridor {

/// The depth of two convex sets: the length of the move by which set b leaves set a. Lengths in
/// metres.
struct Penetration {
  /// Bounds of the depth. After a move of b by `upper` along the direction, the two sets at most
  /// touch. After a move by less than `lower`, they still overlap. Both bounds include all
  /// rounding. If both are 0, the sets do not overlap.
  double lower = 0, upper = 0;
  /// The direction of the move, from a to b: unit, rounded. Zero if the sets do not touch.
  Vec3 direction_W = Vec3::Zero();
  /// The normal, towards b, of a plane that has a on one side and the moved b on the other. For the
  /// least depth, the normal is `direction_W`.
  Vec3 normal_W = Vec3::Zero();
  /// A point of each set, at its position before the move, with p_WA − p_WB = depth·direction_W.
  /// After the move the sets touch at these points. (For flat sets on one plane and a direction in
  /// this plane, `upper` is infinite, and p_WA = p_WB.)
  Vec3 p_WA = Vec3::Zero(), p_WB = Vec3::Zero();
  int rounds = 0;  ///< number of points that the search added to the initial polytope
};

/// Computes the least depth, over all directions, of two convex sets under their maps.
///
/// Guarantee: `lower` ≤ depth ≤ `upper`, in real arithmetic on the given doubles, for sizes and
/// coordinates that are 0 or within 2^±440 m. The bounds differ by at most `accuracy` times the
/// depth, or by 2^-42 of the largest coordinate, unless the search reaches its limit of 500 rounds.
/// In tests, the search reached this limit for some curved or very finely tessellated surfaces, and
/// the bounds then differed by up to 1e-4 of the depth (two equal cylinders) or 0.8 % (two equal
/// spheres under a scaling map, and two equal hulls of 10,000 points on a sphere).
///
/// Method: the depth is the distance of the origin from the boundary of the Minkowski difference A
/// − B. If the cores are apart and only the spheres that sweep them overlap, the distance of the
/// cores gives the depth. Else the expanding polytope algorithm (G. van den Bergen, Proximity
/// queries and penetration depth computation on 3D game objects, 2001) grows an inner polytope. The
/// faces of the inner polytope are exact (convex_surface.h), so flat faces and slivers do no harm.
/// The face closest to the origin gives `lower`, and the support of A − B along the normal of that
/// face gives `upper`. Cost: some 10 to 100 rounds.
/// @param accuracy  the relative accuracy of the depth, ≥ 0.
/// @throws std::invalid_argument if a set, a map or the accuracy is not finite, or the accuracy is
/// negative.
Penetration penetration(const PosedSet& a, const PosedSet& b, double accuracy = 1e-9);

/// Computes the depth along a direction: the length by which b must move along the direction to
/// leave a. The method is that of `penetration`, with the distance of the boundary of A − B along a
/// ray. `lower` ≤ depth ≤ `upper` holds as for `penetration`. The part of upper − lower that comes
/// from rounding is larger by the factor 1/(direction_W·normal_W). If the direction is parallel to
/// the surface where the sets touch, or to flat sets on one plane, `lower` is 0 and `upper` may be
/// infinite.
/// @param direction  not 0, finite.
/// @throws std::invalid_argument if the direction is 0 or not finite, or as `penetration`.
Penetration penetrationAlong(const PosedSet& a, const PosedSet& b, const Vec3& direction,
                             double accuracy = 1e-9);

}  // namespace corridor
