#pragma once

#include <cstdint>

namespace corridor {

/// A pair of leaf primitives: triangles or convex parts. `a` and `b` are numbers in the mesh or the
/// list of parts. Some queries state that they are positions in leaf order instead.
struct PrimitivePair {
  std::uint32_t a = 0, b = 0;
};

}  // namespace corridor
