#pragma once

#include <optional>

#include "collision/core/posed.h"
#include "collision/core/query_context.h"
#include "collision/course/octree.h"
#include "collision/hierarchy/volume_tree.h"
#include "collision/queries/triangle_pair.h"

namespace corridor {

/// The test of queries/interference.h for two octrees (trees over space), and for an octree and a
/// tree of AABBs (a tree over triangles).
std::optional<PrimitivePair> interference(const Posed<Octree>& a, const Posed<Octree>& b,
                                          QueryContext& context);
std::optional<PrimitivePair> interference(const Posed<Octree>& a, const Posed<VolumeTree<Aabb>>& b,
                                          QueryContext& context);

}  // namespace corridor
