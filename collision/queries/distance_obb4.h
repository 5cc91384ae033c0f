#pragma once

#include "collision/core/last_pair.h"
#include "collision/hierarchy/obb4_tree.h"
#include "collision/queries/distance.h"

namespace corridor {

/// `distance` (distance.h, with the same guarantees) for 4-wide OBB trees, several times faster.
///
/// @param last  null, or the closest pair of the last query of these trees. It is used only if both
/// trees hold triangles. The search starts from this pair, and the pair that it finds is stored
/// there. The start changes the distance only within the guaranteed error. It may change which of
/// several closest pairs of triangles is reported.
Distance distance(const Posed<Obb4Tree>& a, const Posed<Obb4Tree>& b,
                  const DistanceOptions& options, QueryContext& context, LastPair* last = nullptr);

/// `closerThan` (distance.h, with the same guarantees) for 4-wide OBB trees, several times faster.
/// @param last  null, or the pair that decided the last query of these trees. It is used only if
/// both trees hold triangles. This pair may be tested first, and the pair that the query finds is
/// stored there. `last` never changes the answer.
bool closerThan(const Posed<Obb4Tree>& a, const Posed<Obb4Tree>& b, double d, QueryContext& context,
                LastPair* last = nullptr);

}  // namespace corridor
