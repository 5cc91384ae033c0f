#pragma once

#include <cstdint>
#include <set>
#include <utility>

#include "collision/geometry/triangle_mesh.h"

/// Oracles for queries on trees: brute force over all pairs of triangles. The tests of contact are
/// exact.
namespace corridor::test {

/// Returns whether two meshes share a point.
bool bruteForceTouch(const TriangleMesh& a, const Transform& X_WA, const TriangleMesh& b,
                     const Transform& X_WB);

/// Pairs of triangle indices: first the triangle of mesh a, then the triangle of mesh b.
using TrianglePairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;
/// Returns all pairs of triangles that touch.
TrianglePairs bruteForcePairs(const TriangleMesh& a, const Transform& X_WA, const TriangleMesh& b,
                              const Transform& X_WB);

/// Returns the least distance of all pairs of triangles, computed by `witnessPoints`; 0 if the
/// meshes touch.
double bruteForceDistance(const TriangleMesh& a, const Transform& X_WA, const TriangleMesh& b,
                          const Transform& X_WB);

}  // namespace corridor::test
