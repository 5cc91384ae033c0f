#include "planner/jobs/module_file.h"

#include <dlfcn.h>
#include <filesystem>

namespace corridor {

OpenModule openModule(const std::string& name, const std::string& buildFolder) {
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  std::string why;
  for (const std::string& file : {(program.parent_path() / name).string(),
                                  (std::filesystem::path(buildFolder) / name).string(), name}) {
    if (void* const handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL)) return {handle, ""};
    // If one of the files exists, report why this file can't be opened.
    const char* const reason = dlerror();
    if (why.empty() || std::filesystem::exists(file, error)) why = reason ? reason : "unknown";
  }
  return {nullptr, why};
}

void* functionIn(const OpenModule& module, const char* name) {
  return module.handle ? dlsym(module.handle, name) : nullptr;
}

}  // namespace corridor
