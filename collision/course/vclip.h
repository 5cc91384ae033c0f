#pragma once

#include <cstdint>

#include "collision/convex/convex_distance.h"
#include "collision/course/polytope_features.h"

namespace corridor {

/// A feature of each of two polytopes. V-Clip ends with such a pair, and the next query begins with
/// it. The caller owns the pair. Any pair is a legal start, so the pair never changes a verdict,
/// nor a distance beyond the distance's error bound.
struct FeaturePair {
  /// If true, the query ignores `a` and `b`, and starts with two vertices that face each other.
  bool cold = true;
  Feature a, b;
  ConvexCache overlap;  ///< the GJK corners of the last contact; four may prove an overlap again
};

/// The distance of two polytopes, and the steps and rounds that the query took.
struct ClosestFeatures {
  ConvexDistance distance;
  /// True: the distance of the pair's features is the distance of the polytopes, up to 1e-10 of
  /// that distance and 2^-40 of the largest coordinate. This holds for coordinates that are 0 or
  /// within 2^±440 m. False: the polytopes touch, a map is not a rotation, or the walk has failed.
  /// Then the pair is only a start for the next query.
  bool closest = false;
  int steps = 0;   ///< pairs of features that V-Clip visited
  int rounds = 0;  ///< rounds of GJK for the proof; 0 if an earlier overlap proof still holds
};

/// Computes the distance of two convex polytopes from their closest features.
///
/// Guaranteed, for any finite maps and any pair:
/// * `distance.distance` is 0 if and only if the polytopes touch, in real arithmetic on the given
///   doubles (exact_contact.h).
/// * Otherwise the distance, its lower bound and the witness points are those that `convexDistance`
///   promises, with the error 1e-12·d + 4·2^-53·S for the true distance d. This holds for
///   coordinates that are 0 or within 2^±440 m. If the gap is below the rounding of double-double,
///   `lower` may be 0, and then `normal_W` may be zero.
/// * The query ends: the walk has a limit of steps, and notices when it repeats a pair.
///
/// Method: B. Mirtich, V-Clip: fast and robust polyhedral collision detection, ACM TOG 17(3), 1998,
/// the robust form of M. Lin and J. Canny's algorithm (1991). From a pair of features, the walk
/// goes to a neighbouring pair that is closer, or of lower dimension and as close, as long as a
/// closest point of one feature is outside the Voronoi region of the other feature. The walk
/// computes in double without proof. GJK, started with the simplex of the pair with which the walk
/// ends, proves the answer. The proof takes one round if the pair is right. GJK also decides if the
/// walk meets an overlap, if it meets a local minimum that is not the global minimum (a vertex
/// below the plane of a face), or if it reaches its limit of steps. At a local minimum, Mirtich's
/// algorithm tests all faces; GJK visits fewer. If the polytopes overlapped at the previous query,
/// the four corners that proved the overlap are tested first.
///
/// Maps that are not rotations (up to 2^-30) are legal, but then the query uses GJK only, because
/// the Voronoi regions are valid for rigid bodies only.
/// @param pair the pair to start with. The query replaces it by the pair with which the walk ended,
/// unless the earlier proof of overlap still holds; then `pair` stays as it is.
ClosestFeatures closestFeatures(const PolytopeFeatures& a, const Transform& X_WA,
                                const PolytopeFeatures& b, const Transform& X_WB,
                                FeaturePair& pair);

}  // namespace corridor
