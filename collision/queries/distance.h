#pragma once

#include <cstdint>
#include <limits>

#include "collision/core/posed.h"
#include "collision/core/query_context.h"
#include "collision/hierarchy/obb_tree.h"
#include "collision/hierarchy/volume_tree.h"

namespace corridor {

/// The error that a distance query may make: the distance reported exceeds the true one by at most
/// relative·(true distance) + absolute. If both are 0, all digits are computed.
struct DistanceOptions {
  double relative = 0;
  double absolute = 0;  ///< metres
  /// Metres, 0 or more. If the distance is larger, the result may be infinite, with meaningless
  /// witness points. A query that needs only short distances is faster with this limit.
  double upTo = std::numeric_limits<double>::infinity();
};

/// The distance of two bodies, and witness points that have this distance. `a` and `b` are the
/// triangles or convex parts that contain these points, by their numbers in the meshes or lists.
struct Distance {
  double distance = 0;  ///< metres
  Vec3 p_WA = Vec3::Zero(), p_WB = Vec3::Zero();
  std::uint32_t a = 0, b = 0;
};

/// Computes the distance between the leaf primitives of two trees. Leaf primitives are triangles or
/// convex parts; convex parts are solid.
///
/// The result is 0 if and only if `interference` reports contact; then the two leaf primitives
/// share a point, and both witness points are this point, up to rounding. Otherwise the error,
/// beyond what the options allow, is at most 1e-12·distance + 4·2^-53·S, and the result is at least
/// 2^-1022. S is the largest number Σ_k |m_ik||v_k| + |t_i| over the coordinates i of all corners
/// v, where x ↦ m·x + t is the map of the corner's body; convex parts count with their radii. If a
/// tree has convex parts and a map is not rigid, S is the largest ‖M‖_F·|v| + |t|. Curved surfaces
/// are not tessellated.
///
/// Method: branch and bound by the volumes' lower bounds, nearest pairs first (Larsen et al. 1999).
/// Distances of leaf primitives are bounded in double. Pairs that may be the closest are measured
/// again in double-double (`witnessPoints`, `convexDistance`).
/// @pre The maps are finite; the options are not negative.
template <BoundingVolume Volume>
Distance distance(const Posed<VolumeTree<Volume>>& a, const Posed<VolumeTree<Volume>>& b,
                  const DistanceOptions& options, QueryContext& context);

/// Tests whether the bodies are at most `d` metres apart (the tolerance query).
///
/// `false` is a proof that they are farther apart than d. `true` may be wrong only in two cases:
/// the distance exceeds d by less than 1e-12·d + 4·2^-53·S + 2^-998 m, or the gap of convex parts
/// is within the band of `convexSetsTouch` (glossary in collision/README.md). For d = 0 the answer
/// is that of `interference`.
/// @pre The maps are finite, and d ≥ 0.
template <BoundingVolume Volume>
bool closerThan(const Posed<VolumeTree<Volume>>& a, const Posed<VolumeTree<Volume>>& b, double d,
                QueryContext& context);

}  // namespace corridor
