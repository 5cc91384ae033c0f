#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "collision/geometry/assimp_import.h"

namespace corridor {

/// What one file may take of assimp.
struct AssimpLimits {
  double seconds = 60;                              ///< from its start to its answer
  std::uint64_t bytes = std::uint64_t{1} << 32;     ///< of memory
  std::filesystem::path program = assimpProgram();  ///< empty: there is none

  /// The helper program corridor_assimp: beside the running program; or in a folder of the run path
  /// that the library's own program or module has (which an installed library gives to those that
  /// link it); or where it was built.
  static std::filesystem::path assimpProgram();
};

/// Reads a file by assimp, in a process of its own that ends with the call, with the caller, and
/// with its limits. Several threads may call it at a time.
/// @throws InputError: assimp can't read the file, crashes over it or exceeds its limits; or there
/// is no helper program.
AssimpImport readWithAssimp(const std::string& file, AssimpRules rules,
                            const AssimpLimits& limits = {});

}  // namespace corridor
