#include "collision/geometry/assimp_module.h"

#include <dlfcn.h>
#include <filesystem>

#include "collision/core/error.h"

namespace corridor {
namespace {

/// The module's function: of the module beside the program, else of the one on its run path (an
/// installed library's), else of the one that was built. @throws std::runtime_error with the
/// reason.
ReadWithAssimp openModule() {
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  const std::string name = CORRIDOR_ASSIMP_MODULE;
  for (const auto& file : {(program.parent_path() / name).string(), name,
                           (std::filesystem::path(CORRIDOR_ASSIMP_DIR) / name).string()})
    if (void* const module = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL))
      if (void* const function = dlsym(module, "corridorReadWithAssimp"))
        return reinterpret_cast<ReadWithAssimp>(function);
  const char* const reason = dlerror();
  throw std::runtime_error(reason ? reason : "unknown");
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
    throw InputError(Fault{
        file, 0,
        "cannot be read as a mesh (OBJ, STL, PLY, OFF, or a format of assimp): " + result.error});
  }
  return result;
}

}  // namespace corridor
