#pragma once

#include <cstdint>
#include <vector>

#include "collision/geometry/triangle_mesh.h"

namespace corridor {

/// The parts of a mesh that hang together: triangles that share an edge are of one component
/// (corners are the same where their positions are, whatever the indices).
struct MeshComponents {
  struct Component {
    std::uint32_t triangle = 0;  ///< one of its triangles
    Vec3 corner = Vec3::Zero();  ///< of that triangle
    Vec3 lower = Vec3::Zero(), upper = Vec3::Zero();
    /// Each edge is used by exactly two triangles, in opposite directions (triangles with two equal
    /// corners aside): it has an inside, whichever way it faces.
    bool watertight = false;
  };
  std::vector<Component> components;
  std::vector<std::uint32_t> of;  ///< the component of each triangle
};

/// @pre `checkMesh` has nothing to complain of.
MeshComponents findComponents(const TriangleMesh& mesh);

}  // namespace corridor
