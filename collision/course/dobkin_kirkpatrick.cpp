#include "collision/course/dobkin_kirkpatrick.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "collision/core/rounding.h"
#include "collision/course/polytope_shadow.h"
#include "collision/predicates/orientation.h"

namespace corridor {

std::uint32_t DobkinKirkpatrick::extreme(const Vec3& direction, Cost* cost) const {
  const double largest = direction.cwiseAbs().maxCoeff();
  // Tiny components may count as 0 in comparisons and products, but not in exact predicates.
  if (!(largest > 0x1p-1000)) {
    if (cost) *cost = {};
    return polytope_.climb(simplex_[0], direction, cost ? &cost->climbs : nullptr);
  }
  // Scaling by a power of two is exact, unless a component vanishes beside the largest one.
  const double unit = powerOfTwo(largest);
  const Vec3 d = direction / unit;
  PolytopeShadow shadow(*this, d);
  while (shadow.level() > 0) shadow.refine();
  std::uint32_t v = shadow.top();
  Cost all = shadow.cost();
  // The directions are compared by their bits, because under denormals-are-zero a subnormal
  // component would count as 0.
  const Vec3 scaledBack = d * unit;
  bool sameDirection = true;
  for (int k = 0; k < 3; ++k)
    sameDirection &=
        std::bit_cast<std::uint64_t>(scaledBack[k]) == std::bit_cast<std::uint64_t>(direction[k]);
  if (!sameDirection || !shadow.isProved()) v = polytope_.climb(v, direction, &all.climbs);
  if (cost) *cost = all;
  return v;
}

std::size_t DobkinKirkpatrick::bytes() const {
  return faces_.size() * sizeof(Face) + rings_.size() * sizeof(Ring) +
         (ringVertex_.size() + ringFace_.size()) * sizeof(std::uint32_t) +
         vertexCounts_.size() * sizeof(std::size_t);
}

std::optional<std::string> DobkinKirkpatrick::check() const {
  const std::span<const Vec3> points = polytope_.vertices();
  // A face belongs to a level if it was born at this level or before, and none of its vertices is
  // removed at this level or before.
  const auto lastLevelOf = [&](const Face& face) {
    return std::min(
        {lastLevel(face.corner[0]), lastLevel(face.corner[1]), lastLevel(face.corner[2])});
  };
  for (std::size_t level = 0; level < levels(); ++level) {
    const std::string where = "level " + std::to_string(level) + ": ";
    std::vector<Polytope::Face> alive;
    for (const Face& face : faces_) {
      if (face.born > level || lastLevelOf(face) < level) continue;
      alive.push_back(face.corner);
      if (face.born != level || level == 0) continue;
      const auto ring = ringOf(face.opposite);
      if (rings_[face.opposite].removed != level) return where + "a face has no opposite vertex";
      for (const std::uint32_t v : face.corner)
        if (std::find(ring.begin(), ring.end(), v) == ring.end())
          return where + "a face has a vertex that is no neighbour of its opposite vertex";
      if (planeSide(points[face.corner[0]], points[face.corner[1]], points[face.corner[2]],
                    points[face.opposite]) < 0)
        return where + "an opposite vertex is below its face";
    }
    if (alive.size() + 4 != 2 * vertexCounts_[level]) return where + "faces are missing";
    if (const auto wrong = checkConvexBoundary(points, alive)) return where + *wrong;
    if (level == 0) continue;
    std::size_t removed = 0;
    for (std::uint32_t v = 0; v < points.size(); ++v) {
      if (rings_[v].removed != level) continue;
      ++removed;
      if (rings_[v].size > kMostNeighbours) return where + "a removed vertex has many neighbours";
      for (const std::uint32_t w : ringOf(v))
        if (rings_[w].removed == level) return where + "two removed vertices are neighbours";
    }
    const std::size_t before = vertexCounts_[level - 1];
    if (vertexCounts_[level] + removed != before) return where + "vertices are missing";
    if (removed < std::max<std::size_t>(1, before / 20)) return where + "few vertices are removed";
  }
  return vertexCounts_.back() == 4 ? std::nullopt : std::optional<std::string>("no simplex");
}

}  // namespace corridor
