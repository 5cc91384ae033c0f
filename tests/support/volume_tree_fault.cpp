#include <algorithm>
#include <vector>

#include "collision/hierarchy/volume_tree.h"
#include "collision/volumes/pair_tests.h"
#include "collision/volumes/part_obb.h"
#include "tests/support/exact_hull.h"
#include "tests/support/exact_round_volumes.h"
#include "tests/support/exact_volume.h"
#include "tests/support/tree_fault.h"

namespace corridor::test {
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
std::optional<std::string> treeFault(const VolumeTree<Volume>& tree) {
  const auto n =
      static_cast<std::uint32_t>(tree.hasParts() ? tree.parts().size() : tree.triangles().size());
  const char* item = tree.hasParts() ? "part" : "triangle";
  std::vector<int> seen(n, 0), ids(n, 0);
  if (tree.nodes()[0].first != 0 || tree.nodes()[0].count != n)
    return "the root does not hold all primitives";
  for (std::uint32_t i = 0; i < tree.nodes().size(); ++i) {
    const auto& node = tree.nodes()[i];
    const ExactVolume<Volume> volume(node.box);
    for (std::uint32_t t = node.first; t < node.first + node.count; ++t) {
      bool inside = true;
      if (tree.hasParts()) {
        inside = containsPart(volume, tree.part(t));
      } else {
        inside = containsTriangle(volume, tree.triangle(t));
      }
      if (!inside)
        return named("the volume of node", i) + " does not contain " +
               named(item, tree.meshTriangle(t));
    }
    if (node.box.axisDefect() > tree.axisDefect())
      return named("the axes of node", i) + " have a larger defect than axisDefect";
    if (node.isLeaf()) {
      for (std::uint32_t t = node.first; t < node.first + node.count; ++t) ++seen[t];
      continue;
    }
    if (i + 1 >= tree.nodes().size() || node.right >= tree.nodes().size())
      return named("node", i) + " has a child that does not exist";
    const auto &left = tree.nodes()[i + 1], &right = tree.nodes()[node.right];
    if (left.count == 0 || right.count == 0 || left.first != node.first ||
        right.first != node.first + left.count || left.count + right.count != node.count)
      return named("node", i) + " is not partitioned by its children";
  }
  for (std::uint32_t t = 0; t < n; ++t) {
    if (seen[t] != 1) return named(item, tree.meshTriangle(t)) + " is not in exactly one leaf";
    if (tree.meshTriangle(t) >= n || ids[tree.meshTriangle(t)]++)
      return "the numbers of the primitives are not a permutation";
  }
  return std::nullopt;
}

#define CORRIDOR_CHECK(Volume) \
  template std::optional<std::string> treeFault(const VolumeTree<Volume>&);
CORRIDOR_EACH_VOLUME(CORRIDOR_CHECK)
#undef CORRIDOR_CHECK

}  // namespace corridor::test
