#pragma once

#include <array>
#include <string>
#include <string_view>

#include "collision/geometry/triangle_mesh.h"

/// What assimp reads for us, and how. Only the helper program (assimp_main.cpp) is linked with
/// assimp; the library runs that program (assimp_process.h).
namespace corridor {

enum class AssimpRules {
  Stored,   ///< coordinates as the file has them: Collada's up-axis is not applied, its unit is
            ///< handed back
  OmplApp,  ///< OMPL.app's: its import steps, and Collada's up-axis and unit applied as assimp does
};

/// The formats that are let through to assimp; README.md says why these. assimp has dozens more,
/// most of them of old games, which nobody's robot is in and nobody maintains.
constexpr std::array<std::string_view, 8> kAssimpFormats{".dae", ".gltf", ".glb", ".fbx",
                                                         ".3ds", ".x3d",  ".3mf", ".amf"};
/// Those that our own readers read. OMPL.app reads them by assimp, and so do its rules.
constexpr std::array<std::string_view, 4> kOwnFormats{".obj", ".stl", ".ply", ".off"};

struct AssimpImport {
  /// All vertices that assimp keeps, those of lines and points too, in the frame of the scene; not
  /// welded.
  TriangleMesh mesh;
  std::string format;   ///< assimp's name of it
  double fileUnit = 0;  ///< metres, not applied to the mesh; 0: the format has none
  bool isCollada = false;
  std::string error;  ///< one line; empty: fine
};

/// Reads a file by assimp, in this process: a damaged file may crash it, or take all of its time
/// and memory. Throws nothing. Defined in the helper program only.
AssimpImport importByAssimp(const std::string& file, AssimpRules rules);

/// The helper's exit status where its memory ends: assimp would take that for a damaged file.
constexpr int kNoMemory = 9;

/// What the helper program writes to its standard output, and back. Both ends are the same build
/// on the same machine.
std::string packed(const AssimpImport& import);
/// @returns false: `bytes` are not all that was packed.
bool unpack(std::string_view bytes, AssimpImport& import);

}  // namespace corridor
