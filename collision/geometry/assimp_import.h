#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "collision/core/error.h"
#include "collision/geometry/cut_polygons.h"
#include "collision/geometry/triangle_mesh.h"

/// Import of mesh files by assimp: rules, formats, and the result. Only the helper program
/// (assimp_main.cpp) is linked with assimp; the library runs that program (assimp_process.h).
namespace corridor {

enum class AssimpRules {
  /// Coordinates as stored, under the transforms of the nodes. Collada's up-axis is not applied.
  /// Collada's unit is not applied either if the transform of assimp's root node is nothing but the
  /// unit; then `fileUnit` is the unit. Otherwise the unit is applied, and `fileUnit` is 1.
  Stored,
  /// The import steps of OMPL.app. Collada's up-axis and unit are applied, as assimp applies them.
  OmplApp,
  /// The frame of `OmplApp`, without its import steps: polygons are not cut into triangles.
  OmplAppPolygons,
};

/// The formats that assimp reads for Corridor (README.md gives the reason for each). It is tested
/// for each of them that vertices arrive as they are stored. assimp has dozens more formats, most
/// of them unmaintained formats of old games, which robots do not use.
constexpr std::array<std::string_view, 4> kAssimpFormats{".dae", ".gltf", ".glb", ".3mf"};
/// A format that is read under `AssimpRules::OmplApp` only. assimp lays its meshes on their side
/// (a stored (x, y, z) arrives as (x, z, -y)) and applies a scale of the file.
constexpr std::string_view kOmplAppFormat = ".3ds";
/// The formats of Corridor's own readers. Under `AssimpRules::OmplApp` assimp reads these formats,
/// too.
constexpr std::array<std::string_view, 4> kOwnFormats{".obj", ".stl", ".ply", ".off"};

struct AssimpImport {
  /// The mesh in the frame of the file's scene. It has all vertices that assimp keeps, including
  /// those of lines and points; equal vertices may be repeated.
  TriangleMesh mesh;
  /// The fans of `mesh` that are polygons. They are not cut yet (`cutPolygons`), because assimp's
  /// way of cutting concave polygons with straight corners is wrong.
  std::vector<PolygonFan> polygons;
  std::string format;   ///< assimp's name of the format
  double fileUnit = 0;  ///< metres, not applied to the mesh; 0: the format has none, or `OmplApp`
  bool isCollada = false;
  /// The up-axis that the format prescribes: 'y' for glTF; 0: others. It is not applied.
  char up = 0;
  std::string error;  ///< one line; empty: success
  /// Content that assimp does not read rightly (assimp_content.h). If there is any, `mesh` must not
  /// be used.
  std::vector<Fault> faults;
  std::vector<std::string> notes;  ///< on content that is not read, without the file's name
  /// The files that assimp opened, without the file itself: buffers of glTF, and others.
  std::vector<std::string> otherFiles;
};

/// Reads a file by assimp in this process. A damaged file may crash the process, or make it take
/// unlimited time and memory. Throws nothing. Defined in the helper program only.
AssimpImport importByAssimp(const std::string& file, AssimpRules rules);

/// The helper program's exit status when it reaches its memory limit. (An exception would not do:
/// assimp would catch it, and report a damaged file.)
constexpr int kOutOfMemoryStatus = 9;

/// Returns the bytes that the helper program writes to its standard output. The format is not
/// portable: both ends are the same build on the same machine.
std::string packed(const AssimpImport& import);
/// Restores the `import` from bytes that `packed` returned. @returns false if `bytes` are
/// incomplete, or are not the output of `packed`.
bool unpack(std::string_view bytes, AssimpImport& import);

}  // namespace corridor
