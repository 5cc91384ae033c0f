#pragma once

#include <cstddef>

namespace corridor {

/// The maximum number of vertices, and of triangles, that are read from one file. A mesh with so
/// many vertices and triangles takes 4 GB, and its tree some 8 GB.
constexpr std::size_t kMaxMeshElements = 100'000'000;

}  // namespace corridor
