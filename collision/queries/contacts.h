#pragma once

#include <cstdint>
#include <vector>

#include "collision/core/query_context.h"
#include "collision/core/transform.h"
#include "collision/hierarchy/volume_tree.h"

namespace corridor {

/// Two triangles that touch, by their numbers in the meshes, and where: the longest segment within
/// the set of points that they share, in the world, metres. Of two triangles that cross that set is
/// the segment; of two that overlap in one plane it is a convex polygon, and the segment joins its
/// two corners that are farthest apart; of two that touch in a point p_W = q_W. Which end is p_W
/// is not told.
struct TriangleContact {
  std::uint32_t a = 0, b = 0;
  Vec3 p_W = Vec3::Zero(), q_W = Vec3::Zero();
};

/// All pairs of triangles, of a under X_WA and of b under X_WB, that touch, each once, in the order
/// in which the trees are walked.
///
/// Which pairs is exact, as `interference` is. The segment's ends are off the true ones by at most
/// 2^-50·S in each coordinate, S the largest Σ|m||v| + |t| of the corners mapped, however flat the
/// angle (`triangle_intersection.h`).
/// @pre both are trees of triangles, not of a convex part; finite maps.
///
/// `Overlap`: as of `interference`.
template <class Overlap = StandardOverlap, BoundingVolume Volume>
std::vector<TriangleContact> contacts(const VolumeTree<Volume>& a, const Transform& X_WA,
                                      const VolumeTree<Volume>& b, const Transform& X_WB,
                                      QueryContext& context);

}  // namespace corridor
