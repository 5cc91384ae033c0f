#include "planner/view/tree_boxes.h"

#include <Eigen/Geometry>

namespace corridor::view {
namespace {

void add(const Obb4Tree& tree, const Obb1& box, bool leaf, const Vec3& origin, TreeBoxes& boxes) {
  Mat3 axes;
  Vec3 center, half;
  for (int k = 0; k < 3; ++k) {
    for (int j = 0; j < 3; ++j) axes(k, j) = box.vectors[k][j];
    center[k] = box.vectors[k][Obb4::kCenter];
    half[k] = box.half[k];
  }
  if (axes.determinant() < 0) axes.col(2) *= -1;  // a right-handed basis of the same box
  const Eigen::Quaterniond q = Eigen::Quaterniond(axes).normalized();
  center = center * tree.length() + (tree.origin() - origin);
  half *= tree.length();
  for (const double x : {center.x(), center.y(), center.z(), q.x(), q.y(), q.z(), q.w(), half.x(),
                         half.y(), half.z()})
    boxes.numbers.push_back(static_cast<float>(x));
  boxes.leaves.push_back(leaf);
}

}  // namespace

TreeBoxes treeBoxes(const Obb4Tree& tree, const Vec3& origin, std::size_t most) {
  TreeBoxes boxes;
  // If the shape is a single convex part, the root's box is the only leaf.
  const bool single = tree.hasParts() && tree.itemCount() == 1;
  add(tree, tree.root(), single, origin, boxes);
  boxes.counts.push_back(1);
  std::vector<std::uint32_t> level;
  if (!single) level.push_back(0);
  while (!level.empty()) {
    TreeBoxes next;
    std::vector<std::uint32_t> below;
    for (const std::uint32_t number : level) {
      const Obb4Tree::Node& node = tree.nodes()[number];
      for (std::uint32_t lane = 0; lane < Obb4Tree::kWidth; ++lane) {
        if (node.child[lane] == Obb4Tree::kNone) continue;
        const bool leaf = Obb4Tree::isLeaf(node.child[lane]);
        add(tree, boxOf(node, lane), leaf, origin, next);
        if (!leaf) below.push_back(node.child[lane]);
      }
      if (boxes.leaves.size() + next.leaves.size() > most) return boxes;
    }
    boxes.numbers.insert(boxes.numbers.end(), next.numbers.begin(), next.numbers.end());
    boxes.leaves.insert(boxes.leaves.end(), next.leaves.begin(), next.leaves.end());
    boxes.counts.push_back(next.leaves.size());
    level = std::move(below);
  }
  return boxes;
}

}  // namespace corridor::view
