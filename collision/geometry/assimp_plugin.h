#pragma once

#include <string>
#include <vector>

#include "collision/geometry/triangle_mesh.h"

/// What the library and its assimp module say to each other. The module is opened at first need
/// (assimp_module.h), so that no program pays for loading assimp unless it reads a file that needs
/// it.
namespace corridor {

enum class AssimpRules {
  Stored,   ///< coordinates as the file has them: Collada's up-axis is not applied, its unit is
            ///< handed back
  OmplApp,  ///< OMPL.app's: its import steps, and Collada's up-axis and unit applied as assimp does
};

struct AssimpImport {
  /// All vertices that assimp keeps, those of lines and points too, in the frame of the scene; not
  /// welded.
  TriangleMesh mesh;
  std::string format;   ///< assimp's name of it
  double fileUnit = 0;  ///< metres, not applied to the mesh; 0: the format has none
  bool isCollada = false;
  std::string error;  ///< one line; empty: fine
};

extern "C" {
/// Exported by the module under this name. Throws nothing.
void corridorReadWithAssimp(const char* file, AssimpRules rules, AssimpImport& result);
}
using ReadWithAssimp = decltype(&corridorReadWithAssimp);

}  // namespace corridor
