#pragma once

#include <memory>

#include "collision/core/file_cache.h"

namespace corridor {

/// Returns the user's cache (`FileCache`), or null if there is none. Its folder is the value of the
/// environment variable CORRIDOR_CACHE, which may also be "off"; or else `corridor` in the folder
/// of the variable XDG_CACHE_HOME, or in ~/.cache (XDG Base Directory Specification 0.8). A home
/// that does not exist has no cache. All programs of one build share their results.
std::shared_ptr<FileCache> userCache();

/// Returns a digest of the libraries that compute the results: of their machine code, which also
/// depends on the compiler and its options (planner/code_digest.cmake).
const char* codeDigest();

}  // namespace corridor
