#pragma once

#include <memory>

#include "collision/core/file_cache.h"

namespace corridor {

/// Returns the user's cache (`FileCache`), or null if there is none. Its folder is the value of the
/// environment variable CORRIDOR_CACHE, which may also be "off"; or else `corridor` in the folder
/// of the variable XDG_CACHE_HOME, or in ~/.cache (XDG Base Directory Specification 0.8).
std::shared_ptr<FileCache> userCache(FileCache::Use use = FileCache::Use::readAndWrite);

}  // namespace corridor
