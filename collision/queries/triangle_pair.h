#pragma once

#include <cstdint>

namespace corridor {

/// A pair of triangles, or of convex parts, by their numbers in the meshes or lists, or in leaf
/// order where a query says so.
struct PrimitivePair {
  std::uint32_t a = 0, b = 0;
};

}  // namespace corridor
