#include "planner/problem/user_cache.h"

#include <cstdlib>
#include <filesystem>
#include <string>

namespace corridor {
namespace {

/// Returns the value of an environment variable, or "" if it is not set.
std::string valueOf(const char* variable) {
  const char* const value = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe): only read
  return value ? value : "";
}

}  // namespace

std::shared_ptr<FileCache> userCache(FileCache::Use use) {
  std::filesystem::path folder = valueOf("CORRIDOR_CACHE");
  if (folder == "off") return nullptr;
  if (folder.empty()) {
    const std::filesystem::path caches = valueOf("XDG_CACHE_HOME"), home = valueOf("HOME");
    // The specification ignores relative paths.
    if (caches.is_absolute())
      folder = caches / "corridor";
    else if (home.is_absolute())
      folder = home / ".cache" / "corridor";
    else
      return nullptr;
  }
  return std::make_shared<FileCache>(folder, use);
}

}  // namespace corridor
