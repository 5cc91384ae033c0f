#pragma once

#include <vector>

#include "collision/geometry/triangle_mesh.h"
#include "planner/verify/edge_curve.h"

namespace corridor::verify {

/// Returns the components of a mesh, as lists of triangles. Triangles that share an edge are in one
/// component; vertices at the same place are one vertex. Two closed surfaces that meet only at a
/// vertex are separate components, because one may be inside the other. If they were one component,
/// the winding number around a point inside both would be 2 or 0, and the point would not count as
/// inside.
std::vector<std::vector<std::uint32_t>> componentsOf(const TriangleMesh& mesh);

/// Returns whether the point is inside any of the components. Each component is assumed to be
/// closed. The solid angles of its triangles (Van Oosterom, Strackee 1983) add up to 4πk, where k
/// is a whole number. k is odd if the point is inside, for either orientation of the triangles.
/// @pre the point is farther from the surface than the rounding error of coordinates. Otherwise the
/// sum might be rounded to the wrong whole number.
bool insideAny(const TriangleMesh& mesh, const std::vector<std::vector<std::uint32_t>>& components,
               const RealVec& point);

}  // namespace corridor::verify
