#pragma once

#include <cstdint>

namespace corridor {

/// Two triangles that touch, by their numbers in the meshes, or convex parts, by theirs.
struct TrianglePair {
  std::uint32_t a = 0, b = 0;
};

}  // namespace corridor
