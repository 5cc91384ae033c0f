#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "collision/core/transform.h"

namespace corridor {

/// A triangle soup: closed triangles over shared vertices, in metres, in the frame of its body.
///
/// Duplicate triangles, holes, non-manifold edges and degenerate triangles are legal; the mesh is
/// the union of its triangles as point sets. Coordinates that are not finite and indices out of
/// range are illegal: `checkMesh` finds them, and readers of mesh files refuse them.
struct TriangleMesh {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;

  const Vec3& corner(std::size_t triangle, int i) const { return vertices[triangles[triangle][i]]; }
};

}  // namespace corridor
