#include "tests/support/brute_force.h"

#include <cmath>
#include <vector>

#include "collision/core/rounding.h"
#include "collision/predicates/triangle_contact.h"
#include "collision/queries/closest_points.h"
#include "tests/support/meshes.h"

namespace corridor::test {
namespace {

/// Calls `found(s, t)` for each touching pair of triangles until `found` returns true. Skips pairs
/// whose axis-aligned boxes in the world, widened by their rounding, do not overlap.
template <class Found>
void forEachTouching(const TriangleMesh& a, const Transform& X_WA, const TriangleMesh& b,
                     const Transform& X_WB, Found&& found) {
  struct Range {
    Vec3 low, high;
  };
  const auto ranges = [](const TriangleMesh& mesh, const Transform& X) {
    std::vector<Range> all;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      const Triangle t = corners(mesh, i);
      const Vec3 p = X * t[0], q = X * t[1], r = X * t[2];
      const Vec3 slack = Vec3::Constant(16 * kUnit * errorScale(t, X) + kTiny);
      all.push_back({p.cwiseMin(q).cwiseMin(r) - slack, p.cwiseMax(q).cwiseMax(r) + slack});
    }
    return all;
  };
  const auto rangesA = ranges(a, X_WA), rangesB = ranges(b, X_WB);
  for (std::uint32_t s = 0; s < rangesA.size(); ++s)
    for (std::uint32_t t = 0; t < rangesB.size(); ++t)
      if (!(rangesA[s].low.array() > rangesB[t].high.array()).any() &&
          !(rangesB[t].low.array() > rangesA[s].high.array()).any() &&
          trianglesTouch(corners(a, s), X_WA, corners(b, t), X_WB) && found(s, t))
        return;
}

}  // namespace

bool bruteForceTouch(const TriangleMesh& a, const Transform& X_WA, const TriangleMesh& b,
                     const Transform& X_WB) {
  bool touch = false;
  forEachTouching(a, X_WA, b, X_WB, [&](std::uint32_t, std::uint32_t) { return touch = true; });
  return touch;
}

TrianglePairs bruteForcePairs(const TriangleMesh& a, const Transform& X_WA, const TriangleMesh& b,
                              const Transform& X_WB) {
  TrianglePairs pairs;
  forEachTouching(a, X_WA, b, X_WB, [&](std::uint32_t s, std::uint32_t t) {
    pairs.insert({s, t});
    return false;
  });
  return pairs;
}

double bruteForceDistance(const TriangleMesh& a, const Transform& X_WA, const TriangleMesh& b,
                          const Transform& X_WB) {
  if (bruteForceTouch(a, X_WA, b, X_WB)) return 0;
  double least = HUGE_VAL;
  for (std::size_t s = 0; s < a.triangles.size(); ++s)
    for (std::size_t t = 0; t < b.triangles.size(); ++t)
      least = std::min(least, witnessPoints(corners(a, s), X_WA, corners(b, t), X_WB).distance);
  return least;
}

}  // namespace corridor::test
