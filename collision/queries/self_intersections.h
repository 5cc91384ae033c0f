#pragma once

#include <vector>

#include "collision/core/query_context.h"
#include "collision/geometry/triangle_mesh.h"
#include "collision/queries/triangle_pair.h"

namespace corridor {

/// Returns all pairs of triangles of a mesh (a < b, in that order) that intersect anywhere except
/// in the corners and edges that they share. Exact. Corners are the same if their positions are
/// equal, whatever their indices. A corner that touches a triangle without being one of its corners
/// counts as an intersection.
///
/// Skipped: triangles whose corners lie on a line, and pairs with the same three corners.
/// `inspectMesh` counts these as degenerate and as repeated. Costs about a microsecond for each of
/// the roughly twelve neighbours of a triangle.
/// @pre `checkMesh` finds no fault.
std::vector<TrianglePair> selfIntersections(const TriangleMesh& mesh, QueryContext& context);

}  // namespace corridor
