#pragma once

#include "collision/hierarchy/obb4_tree.h"
#include "collision/hierarchy/obb4_tree_pose.h"
#include "collision/queries/distance.h"

namespace corridor {

/// The part of `distance` and `closerThan` (distance_obb4.h) for two trees of which at least one
/// holds convex parts. Boxes are filtered in float, sixteen pairs at a time; `NearestParts` and
/// `CloserParts` test the leaf primitives.
/// @param pose the relative pose of the two trees. @pre `pose.apart` is false.
Distance distanceWithParts(const Posed<Obb4Tree>& a, const Posed<Obb4Tree>& b,
                           const Obb4TreePose& pose, const DistanceOptions& options,
                           QueryContext& context);
/// @param d metres, above 0.
bool closerThanWithParts(const Posed<Obb4Tree>& a, const Posed<Obb4Tree>& b,
                         const Obb4TreePose& pose, double d, QueryContext& context);

}  // namespace corridor
