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
  double fileUnit = 0;  ///< metres, by the file or its format; 0: none; not applied yet
  char up = 0;          ///< the up-axis that the file or its format states; 0: none; not applied
  std::vector<std::string> otherFiles = {};  ///< that were read with it
};

ReadMesh readObj(std::string_view text, MeshFaults& faults);
ReadMesh readStl(std::string_view bytes, MeshFaults& faults);
ReadMesh readPly(std::string_view bytes, MeshFaults& faults);
ReadMesh readOff(std::string_view text, MeshFaults& faults);

/// Readers of scenes: the mesh is in the frame of the file's scene, in units of the file.
ReadMesh readCollada(std::string_view text, MeshFaults& faults);
/// @param file the file's name, beside which the buffers are
ReadMesh readGltf(const std::string& file, std::string_view json, MeshFaults& faults);
ReadMesh readGlb(const std::string& file, std::string_view bytes, MeshFaults& faults);
ReadMesh readThreeMf(const std::string& file, MeshFaults& faults);

}  // namespace corridor
