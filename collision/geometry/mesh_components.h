#pragma once

#include <cstdint>
#include <vector>

#include "collision/geometry/triangle_mesh.h"

namespace corridor {

/// The connected components of a mesh: triangles that share an edge belong to one component.
/// Corners are identified by position, not by index.
struct MeshComponents {
  struct Component {
    std::uint32_t triangle = 0;                       ///< a triangle of the component
    Vec3 corner = Vec3::Zero();                       ///< a corner of that triangle
    Vec3 lower = Vec3::Zero(), upper = Vec3::Zero();  ///< bounds of the component
    /// True if the component has edges, and each edge is used by exactly two triangles, in opposite
    /// directions. Triangles with two equal corners do not count. A watertight component has an
    /// inside, no matter whether its triangles face outwards or inwards.
    bool watertight = false;
  };
  std::vector<Component> components;
  std::vector<std::uint32_t> of;  ///< the component of each triangle
};

/// Computes the connected components of a mesh. @pre `checkMesh` reports nothing.
MeshComponents findComponents(const TriangleMesh& mesh);

}  // namespace corridor
