#pragma once

#include <string>

#include "collision/geometry/assimp_plugin.h"

namespace corridor {

/// Reads a file by the assimp module, which is opened at the first call and stays open: beside the
/// running program, or where it was built.
/// @throws InputError: the module can't be opened, or assimp can't read the file, or there is no
/// face in it.
AssimpImport readWithAssimp(const std::string& file, AssimpRules rules);

}  // namespace corridor
