#pragma once

#include <cstdint>

#include "collision/core/query_context.h"
#include "collision/core/transform.h"
#include "collision/hierarchy/obb_tree.h"
#include "collision/hierarchy/volume_tree.h"

namespace corridor {

/// How far the distance told may be above the true one: by relative·true + absolute. 0: the last
/// digits.
struct DistanceOptions {
  double relative = 0;
  double absolute = 0;  ///< metres
};

/// The distance of two bodies, points of either that have it, and their triangles or convex parts,
/// by their numbers in the meshes or lists.
struct Distance {
  double distance = 0;  ///< metres
  Vec3 p_WA = Vec3::Zero(), p_WB = Vec3::Zero();
  std::uint32_t a = 0, b = 0;
};

/// How far are the triangles of a (or its convex parts, solids) under X_WA and those of b under
/// X_WB apart?
///
/// 0 if and only if `interference` says contact; then both points are one that the items share.
/// Else it is off, beyond what the options allow, by at most 1e-12 of itself + 4·2^-53·S, S the
/// largest Σ|m||v| + |t| of the corners mapped (of parts: with their radii), and never told below
/// 2^-1022. Curved surfaces are not tessellated.
///
/// Branch and bound by the volumes' lower bounds, nearest pairs first (Larsen et al. 1999); pairs
/// of items are bounded in double, and those that may be the closest are measured again in
/// double-double (`closestPoints`, `convexDistance`).
/// @pre finite maps, options not negative.
template <BoundingVolume Volume>
Distance distance(const VolumeTree<Volume>& a, const Transform& X_WA, const VolumeTree<Volume>& b,
                  const Transform& X_WB, const DistanceOptions& options, QueryContext& context);

/// The tolerance query: are they at most `d` metres apart?
///
/// `false` is a proof that they are farther apart than d. `true` is right but where the distance
/// exceeds d by less than 1e-12·d + 4·2^-53·S + 2^-998 m, or parts touch in the band of
/// `convexSetsTouch`. For d = 0 it is `interference`.
/// @pre as above, d ≥ 0.
template <BoundingVolume Volume>
bool closerThan(const VolumeTree<Volume>& a, const Transform& X_WA, const VolumeTree<Volume>& b,
                const Transform& X_WB, double d, QueryContext& context);

}  // namespace corridor
