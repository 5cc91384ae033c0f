#include <algorithm>
#include <vector>

#include "collision/hierarchy/exact_hull.h"
#include "collision/hierarchy/exact_round_volumes.h"
#include "collision/hierarchy/exact_volume.h"
#include "collision/hierarchy/volume_tree.h"
#include "collision/volumes/pair_tests.h"
#include "collision/volumes/part_obb.h"

namespace corridor {
namespace {

using exact::ExactVolume;
using exact::named;
using exact::row;

template <class Volume>
bool containsPart(const ExactVolume<Volume>& volume, const ConvexPart& part) {
  if (!part.flatEnds) {
    for (const Vec3& p : part.points)
      if (!volume.contains(row(p), part.radius)) return false;
    return true;
  }
  // A part with discs is inside if its own box contains the discs, the part's spheres (`ballsOf`)
  // contain the corners of that box, and the volume contains these spheres. For an Obb, the discs
  // may also be inside directly.
  const auto holdsDiscs = [&](const ExactVolume<Obb>& box) {
    const exact::Row axis = exact::minus(row(part.points[1]), row(part.points[0]));
    return box.contains(row(part.points[0]), part.radius, axis) &&
           box.contains(row(part.points[1]), part.radius, axis);
  };
  if constexpr (std::is_same_v<Volume, Obb>)
    if (holdsDiscs(volume)) return true;
  const ExactVolume<Obb> own(enclosingObb(part));
  if (!holdsDiscs(own)) return false;
  const std::vector<Ball> balls = ballsOf(part);
  for (const exact::Row& corner : own.corners())
    if (!std::any_of(balls.begin(), balls.end(), [&](const Ball& ball) {
          return ExactVolume<BoundingSphere>({ball.center, ball.radius}).contains(corner, 0);
        }))
      return false;
  return std::all_of(balls.begin(), balls.end(), [&](const Ball& ball) {
    return volume.contains(row(ball.center), ball.radius);
  });
}

template <class Volume>
bool containsTriangle(const ExactVolume<Volume>& volume, const Triangle& triangle) {
  if constexpr (requires { volume.containsTriangle(triangle); })
    return volume.containsTriangle(triangle);
  else  // the volume is convex
    return std::all_of(triangle.begin(), triangle.end(),
                       [&](const Vec3& p) { return volume.contains(row(p), 0); });
}

}  // namespace

template <BoundingVolume Volume>
std::optional<std::string> VolumeTree<Volume>::check() const {
  const std::uint32_t n = items_.size();
  const char* item = items_.parts.empty() ? "triangle" : "part";
  std::vector<int> seen(n, 0), ids(n, 0);
  if (nodes_[0].first != 0 || nodes_[0].count != n) return "the root does not hold all primitives";
  for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
    const Node& node = nodes_[i];
    const ExactVolume<Volume> volume(node.box);
    for (std::uint32_t t = node.first; t < node.first + node.count; ++t) {
      bool inside = true;
      if (hasParts()) {
        inside = containsPart(volume, part(t));
      } else {
        inside = containsTriangle(volume, items_.triangles[t]);
      }
      if (!inside)
        return named("the volume of node", i) + " does not contain " + named(item, meshTriangle(t));
    }
    if (node.box.axisDefect() > bounds_.axisDefect)
      return named("the axes of node", i) + " have a larger defect than axisDefect";
    if (node.isLeaf()) {
      for (std::uint32_t t = node.first; t < node.first + node.count; ++t) ++seen[t];
      continue;
    }
    if (i + 1 >= nodes_.size() || node.right >= nodes_.size())
      return named("node", i) + " has a child that does not exist";
    const Node &left = nodes_[i + 1], &right = nodes_[node.right];
    if (left.count == 0 || right.count == 0 || left.first != node.first ||
        right.first != node.first + left.count || left.count + right.count != node.count)
      return named("node", i) + " is not partitioned by its children";
  }
  for (std::uint32_t t = 0; t < n; ++t) {
    if (seen[t] != 1) return named(item, meshTriangle(t)) + " is not in exactly one leaf";
    if (meshTriangle(t) >= n || ids[meshTriangle(t)]++)
      return "the numbers of the primitives are not a permutation";
  }
  return std::nullopt;
}

#define CORRIDOR_CHECK(Volume) \
  template std::optional<std::string> VolumeTree<Volume>::check() const;
CORRIDOR_EACH_VOLUME(CORRIDOR_CHECK)
#undef CORRIDOR_CHECK

}  // namespace corridor
