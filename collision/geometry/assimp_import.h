#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "collision/geometry/triangle_mesh.h"

/// Import of mesh files by assimp, as OMPL.app imports them: for OMPL.app's frame of a mesh, and
/// for 3DS. All other geometry comes from Corridor's own readers, because assimp misreads files in
/// many ways, of which it reports few. Only the helper program (assimp_main.cpp) is linked with
/// assimp; the library runs that program (assimp_process.h).
namespace corridor {

struct AssimpImport {
  /// The mesh in the frame of the file's scene; Collada's up-axis and unit are applied. It has all
  /// vertices that assimp keeps, including those of lines and points; equal vertices may be
  /// repeated.
  TriangleMesh mesh;
  std::string error;  ///< one line; empty: success
  /// The files that assimp opened, without the file itself: buffers of glTF, and others.
  std::vector<std::string> otherFiles;
};

/// Reads a file by assimp in this process. A damaged file may crash the process, or make it take
/// unlimited time and memory. Throws nothing. Defined in the helper program only.
AssimpImport importByAssimp(const std::string& file);

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
