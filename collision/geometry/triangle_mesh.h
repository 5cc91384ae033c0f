#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "collision/core/transform.h"

namespace corridor {

/// A triangle soup: closed triangles over shared vertices, in metres, in the frame of its body.
///
/// Duplicates, holes, non-manifold edges and degenerate triangles are legal and are the point sets
/// that they are. Not legal: non-finite coordinates, indices out of range (`checkMesh` finds them;
/// mesh files are checked at reading).
struct TriangleMesh {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;

  const Vec3& corner(std::size_t triangle, int i) const { return vertices[triangles[triangle][i]]; }
};

}  // namespace corridor
