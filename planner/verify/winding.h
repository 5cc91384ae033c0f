#pragma once

#include <vector>

#include "collision/geometry/triangle_mesh.h"
#include "planner/verify/edge_curve.h"

namespace corridor::verify {

/// The connected components of a mesh (corners at the same place are one), each with its triangles.
std::vector<std::vector<std::uint32_t>> componentsOf(const TriangleMesh& mesh);

/// Is the point inside any one of the components? Each is taken as closed; the solid angles of its
/// triangles (Van Oosterom, Strackee 1983) add up to a whole multiple of 4π, odd inside, by
/// whatever sense its triangles turn. @pre the point is not on the surface by more than rounding:
/// the sum is rounded to the nearest whole number.
bool insideAny(const TriangleMesh& mesh, const std::vector<std::vector<std::uint32_t>>& components,
               const RealVec& point);

}  // namespace corridor::verify
