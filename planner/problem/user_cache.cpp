#include "planner/problem/user_cache.h"

#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

#include "collision/core/spelling.h"

namespace corridor {
namespace {

/// Returns the value of an environment variable, or "" if it is not set.
std::string valueOf(const char* variable) {
  const char* const value = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe): only read
  return value ? value : "";
}

}  // namespace

std::shared_ptr<FileCache> userCache() {
  std::filesystem::path folder = valueOf("CORRIDOR_CACHE");
  const std::string word = lowered(folder.string());
  if (word == "off" || word == "no" || word == "false" || word == "0") return nullptr;
  std::error_code none;
  if (folder.empty()) {
    const std::filesystem::path caches = valueOf("XDG_CACHE_HOME"), home = valueOf("HOME");
    // The specification ignores relative paths.
    if (caches.is_absolute())
      folder = caches / "corridor";
    else if (home.is_absolute() && std::filesystem::is_directory(home, none))
      folder = home / ".cache" / "corridor";
    else
      return nullptr;
  }
  // A program may change its working directory.
  const std::filesystem::path absolute = std::filesystem::absolute(folder, none);
  return std::make_shared<FileCache>(none ? folder : absolute.lexically_normal(), codeDigest());
}

}  // namespace corridor
