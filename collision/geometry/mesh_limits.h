#pragma once

#include <cstddef>

namespace corridor {

/// The most vertices, and triangles, that are read of one file: 4 GB of a mesh, and some 8 of its
/// tree.
constexpr std::size_t kMostOfAMesh = 100'000'000;

}  // namespace corridor
