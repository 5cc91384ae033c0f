#pragma once

#include <vector>

#include "collision/core/query_context.h"
#include "collision/geometry/triangle_mesh.h"
#include "collision/queries/triangle_pair.h"

namespace corridor {

/// All pairs of triangles of a mesh (a < b, in that order) that intersect anywhere but in the
/// corners and edges that they share. Exact. Corners are the same where their positions are,
/// whatever their indices. A corner that touches a triangle without being one of its corners
/// counts.
///
/// Left aside: triangles whose corners lie on a line, and pairs with the same three corners, which
/// `inspectMesh` counts as degenerate and repeated. About a microsecond for each of the some
/// twelve neighbours that a triangle has.
/// @pre `checkMesh` has nothing to complain of.
std::vector<TrianglePair> selfIntersections(const TriangleMesh& mesh, QueryContext& context);

}  // namespace corridor
