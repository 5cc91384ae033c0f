#pragma once

#include <vector>

#include "collision/geometry/triangle_mesh.h"
#include "planner/verify/edge_curve.h"

namespace corridor::verify {

/// Returns the components of a mesh, as lists of triangles. Triangles that share an edge are in one
/// component; vertices at the same place are one vertex. Two closed surfaces that meet only at a
/// vertex are separate components, because one may be inside the other. As one component, they
/// would have the winding number 2 or 0 around a point inside both, which does not count as inside.
std::vector<std::vector<std::uint32_t>> componentsOf(const TriangleMesh& mesh);

/// Returns whether the point is inside any of the components. Each component is assumed to be
/// closed. The solid angles of its triangles (Van Oosterom, Strackee 1983) add up to 4πk, where k
/// is a whole number. k is odd if the point is inside, for either orientation of the triangles.
/// @pre the point is farther from the surface than the rounding error, because the sum is rounded
/// to the nearest whole number.
bool insideAny(const TriangleMesh& mesh, const std::vector<std::vector<std::uint32_t>>& components,
               const RealVec& point);

}  // namespace corridor::verify
