#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "collision/geometry/mesh_text.h"
#include "collision/geometry/stated_unit.h"
#include "collision/geometry/triangle_mesh.h"

/// Corridor's own mesh readers, one per format. Each reader takes the bytes of a file, and returns
/// coordinates as stored, in double. README.md lists what the readers support, and their limits.
/// Readers add every fault to `faults`, and throw InputError if there is one.
namespace corridor {

struct ReadMesh {
  TriangleMesh mesh;
  std::string format;                   ///< name of the format for messages, e.g. "STL (binary)"
  std::vector<std::string> notes = {};  ///< on content that is not read
  std::vector<StatedUnit> statedUnits = {};  ///< in comments, headers and names; not applied
};

ReadMesh readObj(std::string_view text, MeshFaults& faults);
ReadMesh readStl(std::string_view bytes, MeshFaults& faults);
ReadMesh readPly(std::string_view bytes, MeshFaults& faults);
ReadMesh readOff(std::string_view text, MeshFaults& faults);

/// Checks an OBJ file that assimp reads: its keywords, as `readObj` does, and lines that assimp
/// drops. All other faults are left to assimp. @throws InputError if there is a fault.
void checkObjForAssimp(std::string_view text, MeshFaults& faults);

}  // namespace corridor
