#pragma once

#include <memory>

#include "collision/core/file_cache.h"
#include "planner/model/model.h"

namespace corridor::app {

/// Returns the user's cache. @throws InputError if there is none, or it can't be used.
std::shared_ptr<FileCache> requireCache();

/// Builds the trees and hulls of large meshes, and the grids of pairs of links, that the model's
/// cache does not have, and saves them there. @pre the model has a cache.
/// @throws InputError with the notes of the cache if one can't be written.
void fillCache(const Model& model);
/// @throws InputError with the notes of a cache, if there are some.
void requireNoNotes(FileCache& cache);

}  // namespace corridor::app
