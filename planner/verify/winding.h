#pragma once

#include <vector>

#include "collision/geometry/triangle_mesh.h"
#include "planner/verify/edge_curve.h"

namespace corridor::verify {

/// The components of a mesh, each with its triangles: those that share an edge hang together
/// (corners at the same place are one). Shells that meet in a corner alone are components of their
/// own: one may be in the other, and together they turn twice about what is in both, or not at all.
std::vector<std::vector<std::uint32_t>> componentsOf(const TriangleMesh& mesh);

/// Is the point inside any one of the components? Each is taken as closed; the solid angles of its
/// triangles (Van Oosterom, Strackee 1983) add up to a whole multiple of 4π, odd inside, by
/// whatever sense its triangles turn. @pre the point is not on the surface by more than rounding:
/// the sum is rounded to the nearest whole number.
bool insideAny(const TriangleMesh& mesh, const std::vector<std::vector<std::uint32_t>>& components,
               const RealVec& point);

}  // namespace corridor::verify
