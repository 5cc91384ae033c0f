#pragma once

#include <cstdint>
#include <vector>

#include "collision/core/posed.h"
#include "collision/core/query_context.h"
#include "collision/hierarchy/volume_tree.h"

namespace corridor {

/// Two triangles that touch, by their numbers in the meshes, and the longest segment within the set
/// of points that they share (world frame, metres). It is unspecified which end is `p_W`.
///
/// For triangles that cross, that set is the segment itself. For triangles that overlap in one
/// plane, it is a convex polygon, and the segment joins the two corners of the polygon that are
/// farthest apart. For triangles that touch in one point, p_W = q_W.
struct TriangleContact {
  std::uint32_t a = 0, b = 0;
  Vec3 p_W = Vec3::Zero(), q_W = Vec3::Zero();
};

/// Returns all pairs of touching triangles of two trees, each pair once, in the order in which the
/// traversal finds them.
///
/// The set of pairs is exact, as for `interference`. Each coordinate of a segment's ends is off by
/// at most 2^-50·S, where S is the largest Σ|m||v| + |t| of the mapped corners. This holds for any
/// angle between the triangles (`triangle_intersection.h`).
/// @pre Both are trees of triangles, not of convex parts.
/// @throws std::invalid_argument if a map is not finite.
/// @tparam Overlap  as in `interference`.
template <class Overlap = StandardOverlap, BoundingVolume Volume>
std::vector<TriangleContact> contacts(const Posed<VolumeTree<Volume>>& a,
                                      const Posed<VolumeTree<Volume>>& b, QueryContext& context);

}  // namespace corridor
