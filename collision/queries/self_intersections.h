#pragma once

#include <vector>

#include "collision/core/query_context.h"
#include "collision/geometry/triangle_mesh.h"
#include "collision/queries/triangle_pair.h"

namespace corridor {

/// Returns all pairs of triangles of a mesh that intersect anywhere except in the corners and edges
/// that they share. In each pair a < b; the pairs are sorted by a, then by b. The result is exact.
/// Corners are the same if their positions are equal, whatever their indices. A corner that touches
/// a triangle without being one of its corners counts as an intersection.
///
/// Two kinds are skipped: triangles whose corners lie on a line, and pairs with the same three
/// corners. `inspectMesh` counts such triangles as degenerate, and such pairs as repeated. Cost:
/// about a microsecond for each of the roughly twelve neighbours of a triangle.
/// @pre `checkMesh` finds no fault.
std::vector<PrimitivePair> selfIntersections(const TriangleMesh& mesh, QueryContext& context);

}  // namespace corridor
