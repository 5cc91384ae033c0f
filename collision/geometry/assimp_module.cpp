#include "collision/geometry/assimp_module.h"

#include <dlfcn.h>
#include <filesystem>

#include "collision/core/error.h"

namespace corridor {
namespace {

/// The module's function. @throws std::runtime_error with the reason.
ReadWithAssimp openModule() {
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  const auto beside = program.parent_path() / CORRIDOR_ASSIMP_MODULE;
  const auto built = std::filesystem::path(CORRIDOR_ASSIMP_DIR) / CORRIDOR_ASSIMP_MODULE;
  const auto& path = std::filesystem::exists(beside, error) ? beside : built;
  void* const module = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  void* const function = module ? dlsym(module, "corridorReadWithAssimp") : nullptr;
  if (!function) throw std::runtime_error(dlerror());
  return reinterpret_cast<ReadWithAssimp>(function);
}

}  // namespace

AssimpImport readWithAssimp(const std::string& file, AssimpRules rules) {
  ReadWithAssimp function = nullptr;
  try {
    static const ReadWithAssimp opened = openModule();
    function = opened;
  } catch (const std::runtime_error& error) {
    throw InputError(Fault{file, 0,
                           std::string("only assimp may know this format, and its module ") +
                               CORRIDOR_ASSIMP_MODULE + " cannot be opened: " + error.what()});
  }
  AssimpImport result;
  function(file.c_str(), rules, result);
  if (!result.error.empty()) {
    throw InputError(
        Fault{file, 0,
              "cannot be read as a mesh (OBJ, STL, PLY, or a format of assimp): " + result.error});
  }
  return result;
}

}  // namespace corridor
