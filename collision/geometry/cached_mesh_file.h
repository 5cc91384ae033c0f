#pragma once

#include <functional>
#include <string>

#include "collision/core/file_cache.h"
#include "collision/geometry/mesh_file.h"

namespace corridor {

/// Returns what `read` returns, which must depend only on the other arguments: from the cache if it
/// has it, or else by calling `read`. Then the result is offered to the cache, unless the file is
/// so small that reading it again takes no longer.
/// @param bytes of the mesh file. @param extension of its name, in lower case
MeshFile cachedMeshFile(const std::string& bytes, const std::string& extension,
                        const MeshFileOptions& options, FileCache& cache,
                        const std::function<MeshFile()>& read);

}  // namespace corridor
