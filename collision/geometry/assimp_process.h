#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "collision/geometry/assimp_import.h"

namespace corridor {

/// Limits for reading one file by assimp, and the path of the helper program that reads the file.
struct AssimpLimits {
  double seconds = 60;                              ///< time from the helper's start to its answer
  std::uint64_t bytes = std::uint64_t{1} << 32;     ///< memory of the helper
  std::filesystem::path program = assimpProgram();  ///< empty: not found

  /// Returns the path of the helper program corridor_assimp, or "" if it is not found. Searches, in
  /// this order:
  /// * the folder of the running program;
  /// * the folders in which the program or shared library that contains this code searches for
  ///   libraries, such as its run path (an installed library adds its folder for programs that link
  ///   it);
  /// * the folder where the helper was built.
  static std::filesystem::path assimpProgram();
};

/// Reads a file by assimp in a process of its own. The new process ends when this call or the
/// calling thread ends, or when the new process reaches a limit. Several threads may call this
/// function at the same time.
/// @throws InputError: assimp cannot read the file, crashes, or exceeds a limit; or the helper
/// program is missing or cannot be started.
AssimpImport readWithAssimp(const std::string& file, const AssimpLimits& limits = {});

}  // namespace corridor
