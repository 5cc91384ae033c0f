#include "collision/hierarchy/exact_volume.h"
#include "collision/hierarchy/obb4_tree.h"
#include "collision/hierarchy/volume_tree.h"
#include "collision/volumes/part_obb.h"

namespace corridor {
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

std::string named(const char* what, std::size_t i) {
  return std::string(what) + " " + std::to_string(i);
}

}  // namespace

std::optional<std::string> Obb4Tree::check() const {
  using exact::Rational;
  using exact::Row;
  if (part_) {
    // Proves that the part is inside its enclosing box, and that this box is inside the boxes in
    // float.
    if (auto complaint = VolumeTree<Obb>(*part_).check()) return complaint;
    const exact::ExactVolume<Obb> around(inDouble(boxOf(nodes_[0], 0))), root(inDouble(root_));
    for (Row corner : exact::ExactVolume<Obb>(enclosingObb(*part_)).corners()) {
      corner = exact::minus(corner, exact::row(origin_));
      for (Rational& x : corner) x /= Rational(length_);
      if (!around.contains(corner, 0) || !root.contains(corner, 0))
        return "the box does not contain the part";
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
  // Each item is a node, with all boxes above it.
  std::vector<int> visited(nodes_.size(), 0), seen(triangles_.size(), 0);
  struct Item {
    std::uint32_t node;
    std::vector<exact::ExactVolume<Obb>> above;
  };
  if (auto complaint = complaintOf(inDouble(root_))) return *complaint + " (root box)";
  std::vector<Item> stack;
  stack.push_back({0, {exact::ExactVolume<Obb>(inDouble(root_))}});
  while (!stack.empty()) {
    const Item item = std::move(stack.back());
    stack.pop_back();
    if (item.node >= nodes_.size() || visited[item.node]++)
      return named("node", item.node) + " is not the child of exactly one box";
    const Node& node = nodes_[item.node];
    for (std::uint32_t lane = 0; lane < kWidth; ++lane) {
      const std::uint32_t child = node.child[lane];
      if (child == kNone) continue;
      const Obb box = inDouble(boxOf(node, lane));
      if (auto complaint = complaintOf(box)) return *complaint + named(" in node", item.node);
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
      return named("triangle", t) + " (leaf order) is in no leaf, or has the number of another";
  for (std::size_t i = 0; i < nodes_.size(); ++i)
    if (!visited[i]) return named("node", i) + " is the child of no box";
  return std::nullopt;
}

}  // namespace corridor
