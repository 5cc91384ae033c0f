#pragma once

#include <string>
#include <string_view>

#include "collision/geometry/mesh_text.h"
#include "collision/geometry/triangle_mesh.h"

/// Our own readers, one a format. They take the bytes of the file and hand back coordinates as
/// stored, in double; the limits of each are told in README.md. Every fault goes to `faults`; all
/// throw InputError where there is one.
namespace corridor {

struct ReadMesh {
  TriangleMesh mesh;
  std::string format;  ///< for people, e.g. "STL (binary)"
};

ReadMesh readObj(std::string_view text, MeshFaults& faults);
ReadMesh readStl(std::string_view bytes, MeshFaults& faults);
ReadMesh readPly(std::string_view bytes, MeshFaults& faults);
ReadMesh readOff(std::string_view text, MeshFaults& faults);

}  // namespace corridor
