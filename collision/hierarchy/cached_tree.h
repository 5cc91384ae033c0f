#pragma once

#include <memory>
#include <optional>

#include "collision/convex/enclosing_hull.h"
#include "collision/core/file_cache.h"
#include "collision/hierarchy/obb4_tree.h"

namespace corridor {

/// These functions return what the `Obb4Tree` constructor and `enclosingHull` compute for a mesh.
/// For a large mesh, they look into the cache first, and offer it what they computed.
/// @param cache null: none.
/// @throws what the constructor throws.
std::shared_ptr<const Obb4Tree> cachedTree(const TriangleMesh& mesh, ObbFit fit, FileCache* cache);
std::optional<EnclosingHull> cachedHull(const TriangleMesh& mesh, FileCache* cache);

}  // namespace corridor
