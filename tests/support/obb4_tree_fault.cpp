#include <algorithm>

#include "collision/volumes/part_obb.h"
#include "tests/support/exact_volume.h"
#include "tests/support/tree_fault.h"

namespace corridor::test {
namespace {

Obb inDouble(const Obb1& floats) {
  Obb box;
  for (int j = 0; j < 3; ++j) {
    box.center[j] = floats.vectors[j][Obb4::kCenter];
    box.half[j] = floats.half[j];
    for (int k = 0; k < 3; ++k) box.axes(k, j) = floats.vectors[k][j];
  }
  return box;
}

/// Returns the first violation of the assumptions of obb4.h about a box, or nothing.
std::optional<std::string> complaintOf(const Obb& box) {
  if (box.half[0] < box.half[1] || box.half[0] < box.half[2])
    return "the first side is not the longest";
  if (!(orthonormalityDefect(box.axes) <= 2.2 * 0x1p-24)) return "the axes are not orthonormal";
  if (!(box.center.norm() <= 3)) return "the centre of a box is too far from the origin";
  return std::nullopt;
}

using exact::named;
using Volume = exact::ExactVolume<Obb>;

/// Tests whether the volume, in the tree's frame and unit, contains a triangle. `own` maps a point
/// to this frame.
template <class Own>
bool contains(const Volume& volume, const Triangle& triangle, const Own& own) {
  return std::all_of(triangle.begin(), triangle.end(), [&](const Vec3& corner) {
    return volume.contains(own(exact::row(corner)), 0);
  });
}

/// Tests whether the volume contains a convex part: the spheres about its points, or the discs of a
/// cylinder. If the volume is not proved to contain the discs directly, it must contain a box that
/// is proved to contain them: the part's own box (`enclosingObb`).
template <class Own>
bool contains(const Volume& volume, const ConvexPart& part, const Own& own,
              const exact::Rational& unit) {
  if (!part.flatEnds)
    return std::all_of(part.points.begin(), part.points.end(), [&](const Vec3& p) {
      return volume.contains(own(exact::row(p)), exact::Rational(part.radius) / unit);
    });
  const exact::Row ends[2] = {exact::row(part.points[0]), exact::row(part.points[1])},
                   axis = exact::minus(ends[1], ends[0]);
  const exact::Rational radius(part.radius), ownRadius = radius / unit;
  if (volume.contains(own(ends[0]), ownRadius, axis) &&
      volume.contains(own(ends[1]), ownRadius, axis))
    return true;
  const Volume box(enclosingObb(part));
  if (!box.contains(ends[0], radius, axis) || !box.contains(ends[1], radius, axis)) return false;
  const auto corners = box.corners();
  return std::all_of(corners.begin(), corners.end(),
                     [&](const exact::Row& corner) { return volume.contains(own(corner), 0); });
}

}  // namespace

std::optional<std::string> treeFault(const Obb4Tree& tree) {
  using exact::Rational;
  using exact::Row;
  const Rational unit(tree.length());
  const Row origin = exact::row(tree.origin());
  const auto own = [&](Row p) {
    p = exact::minus(p, origin);
    for (Rational& x : p) x /= unit;
    return p;
  };
  const std::size_t count = tree.itemCount();
  const char* const kind = tree.hasParts() ? "part" : "triangle";
  // Each item is a node, with the volumes of all boxes above it.
  std::vector<int> visited(tree.nodes().size(), 0), seen(count, 0);
  struct Item {
    std::uint32_t node;
    std::vector<Volume> above;
  };
  if (auto complaint = complaintOf(inDouble(tree.root()))) return *complaint + " (root box)";
  std::vector<Item> stack;
  stack.push_back({0, {Volume(inDouble(tree.root()))}});
  while (!stack.empty()) {
    const Item item = std::move(stack.back());
    stack.pop_back();
    if (item.node >= tree.nodes().size() || visited[item.node]++)
      return named("node", item.node) + " is not the child of exactly one box";
    const Obb4Tree::Node& node = tree.nodes()[item.node];
    for (std::uint32_t lane = 0; lane < Obb4Tree::kWidth; ++lane) {
      const std::uint32_t child = node.child[lane];
      if (child == Obb4Tree::kNone) continue;
      const Obb box = inDouble(boxOf(node, lane));
      if (auto complaint = complaintOf(box)) return *complaint + named(" in node", item.node);
      std::vector<Volume> boxes = item.above;
      boxes.emplace_back(box);
      if (!Obb4Tree::isLeaf(child)) {
        stack.push_back({child, std::move(boxes)});
        continue;
      }
      for (std::uint32_t t = Obb4Tree::leafFirst(child);
           t < Obb4Tree::leafFirst(child) + Obb4Tree::leafCount(child); ++t) {
        if (t >= count || seen[t]++)
          return named(kind, t) + " (leaf order) is not in exactly one leaf";
        for (const auto& around : boxes)
          if (!(tree.hasParts() ? contains(around, tree.part(t), own, unit)
                                : contains(around, tree.triangle(t), own)))
            return "a box above does not contain " + named(kind, tree.meshTriangle(t));
      }
    }
  }
  std::vector<int> ids(count, 0);
  for (std::uint32_t t = 0; t < count; ++t)
    if (!seen[t] || tree.meshTriangle(t) >= ids.size() || ids[tree.meshTriangle(t)]++)
      return named(kind, t) + " (leaf order) is in no leaf, or has the number of another";
  for (std::size_t i = 0; i < tree.nodes().size(); ++i)
    if (!visited[i]) return named("node", i) + " is the child of no box";
  return std::nullopt;
}

}  // namespace corridor::test
