#pragma once

#include <cstdint>
#include <set>
#include <utility>

#include "collision/geometry/triangle_mesh.h"

/// What trees are tested against: the double loop over exact triangle tests.
namespace corridor::test {

/// Do two meshes share a point?
bool bruteForceTouch(const TriangleMesh& a, const Transform& X_WA, const TriangleMesh& b,
                     const Transform& X_WB);

/// All pairs of triangles that touch, by their numbers.
using TrianglePairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;
TrianglePairs bruteForcePairs(const TriangleMesh& a, const Transform& X_WA, const TriangleMesh& b,
                              const Transform& X_WB);

/// Their distance by `closestPoints` of each pair: 0 where they touch.
double bruteForceDistance(const TriangleMesh& a, const Transform& X_WA, const TriangleMesh& b,
                          const Transform& X_WB);

}  // namespace corridor::test
