#include "collision/hierarchy/exact_volume.h"
#include "collision/hierarchy/volume_tree.h"
#include "collision/hierarchy/wide_obb_tree.h"
#include "collision/volumes/part_obb.h"

namespace corridor {
namespace {

Obb boxOf(const WideObbTree::Node& node, std::uint32_t lane) {
  Obb box;
  for (int j = 0; j < 3; ++j) {
    box.center[j] = node.vectors[j][Obb4::kCenter][lane];
    box.half[j] = node.half[j][lane];
    for (int k = 0; k < 3; ++k) box.axes(k, j) = node.vectors[k][j][lane];
  }
  return box;
}

std::string named(const char* what, std::size_t i) {
  return std::string(what) + " " + std::to_string(i);
}

}  // namespace

std::optional<std::string> WideObbTree::check() const {
  using exact::Rational;
  using exact::Row;
  if (part_) {
    // The part is in its enclosing box, and that in the node's.
    if (auto complaint = VolumeTree<Obb>(*part_).check()) return complaint;
    const exact::ExactVolume<Obb> around(boxOf(nodes_[0], 0));
    for (Row corner : exact::ExactVolume<Obb>(enclosingObb(*part_)).corners()) {
      corner = exact::minus(corner, exact::row(origin_));
      for (Rational& x : corner) x /= Rational(length_);
      if (!around.contains(corner, 0)) return "the box does not contain the part";
    }
    return std::nullopt;
  }
  const Rational unit(length_);
  const Row origin = exact::row(origin_);
  const auto own = [&](std::uint32_t triangle, int k) {
    Row p = exact::minus(exact::row(corner(triangle, k)), origin);
    for (Rational& x : p) x /= unit;
    return p;
  };
  // A node's boxes with all boxes above: (node, the boxes on the way).
  std::vector<int> visited(nodes_.size(), 0), seen(triangles_.size(), 0);
  struct Item {
    std::uint32_t node;
    std::vector<exact::ExactVolume<Obb>> above;
  };
  std::vector<Item> stack;
  stack.push_back({0, {}});
  while (!stack.empty()) {
    const Item item = std::move(stack.back());
    stack.pop_back();
    if (item.node >= nodes_.size() || visited[item.node]++)
      return named("node", item.node) + " is not the child of exactly one box";
    const Node& node = nodes_[item.node];
    for (std::uint32_t lane = 0; lane < kWidth; ++lane) {
      const std::uint32_t child = node.child[lane];
      if (child == kNone) continue;
      const Obb box = boxOf(node, lane);
      if (box.half[0] < box.half[1] || box.half[0] < box.half[2])
        return named("the first side is not the longest in node", item.node);
      // obb4.h counts on both.
      if (!(orthonormalityDefect(box.axes) <= 2.2 * 0x1p-24))
        return named("the axes are not orthonormal in node", item.node);
      if (!(box.center.norm() <= 3)) return named("a box is too far off in node", item.node);
      std::vector<exact::ExactVolume<Obb>> boxes = item.above;
      boxes.emplace_back(box);
      if (!isLeaf(child)) {
        stack.push_back({child, std::move(boxes)});
        continue;
      }
      for (std::uint32_t t = leafFirst(child); t < leafFirst(child) + leafCount(child); ++t) {
        if (t >= triangles_.size() || seen[t]++)
          return named("triangle", t) + " (leaf order) is not in exactly one leaf";
        for (int k = 0; k < 3; ++k)
          for (const auto& around : boxes)
            if (!around.contains(own(t, k), 0))
              return "a box above does not contain " + named("triangle", meshTriangle_[t]);
      }
    }
  }
  std::vector<int> ids(triangles_.size(), 0);
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    if (!seen[t] || meshTriangle_[t] >= ids.size() || ids[meshTriangle_[t]]++)
      return named("triangle", t) + " (leaf order) is in no leaf, or its number is another's";
  for (std::size_t i = 0; i < nodes_.size(); ++i)
    if (!visited[i]) return named("node", i) + " is the child of no box";
  return std::nullopt;
}

}  // namespace corridor
