#pragma once

#include "collision/hierarchy/obb4_tree.h"
#include "collision/queries/distance.h"

namespace corridor {

/// `distance` (distance.h, with the same guarantees) for 4-wide OBB trees, several times faster.
///
/// Starts from the closest pair of the last query of these trees, which the context remembers.
/// Earlier queries change the answer only within the guaranteed error. They may change which of
/// several closest pairs of triangles is reported.
Distance distance(const Obb4Tree& a, const Transform& X_WA, const Obb4Tree& b,
                  const Transform& X_WB, const DistanceOptions& options, QueryContext& context);

/// `closerThan` (distance.h, with the same guarantees) for 4-wide OBB trees, several times faster.
/// What the context remembers never changes the answer.
bool closerThan(const Obb4Tree& a, const Transform& X_WA, const Obb4Tree& b, const Transform& X_WB,
                double d, QueryContext& context);

}  // namespace corridor
