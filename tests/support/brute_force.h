#pragma once

#include <cstdint>
#include <set>
#include <utility>

#include "collision/geometry/triangle_mesh.h"

/// Oracles for queries on trees: brute force over all pairs of triangles, by exact tests.
namespace corridor::test {

/// Returns whether two meshes share a point.
bool bruteForceTouch(const TriangleMesh& a, const Transform& X_WA, const TriangleMesh& b,
                     const Transform& X_WB);

/// Pairs of triangles by their numbers; `bruteForcePairs` returns all that touch.
using TrianglePairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;
TrianglePairs bruteForcePairs(const TriangleMesh& a, const Transform& X_WA, const TriangleMesh& b,
                              const Transform& X_WB);

/// Returns the least distance of all pairs of triangles, computed by `witnessPoints`; 0 if the
/// meshes touch.
double bruteForceDistance(const TriangleMesh& a, const Transform& X_WA, const TriangleMesh& b,
                          const Transform& X_WB);

}  // namespace corridor::test
