#include "collision/hierarchy/tree_builder.h"

#include <algorithm>
#include <array>
#include <functional>
#include <numeric>

#include "collision/hierarchy/cluster.h"
#include "collision/volumes/part_obb.h"

namespace corridor {
namespace {

struct Framed {
  ObbFrame frame;
  Obb box;
};

Framed framed(const TreePrimitives& items, std::uint32_t first, std::uint32_t count, bool oriented,
              ObbFit fit) {
  if (oriented && count == 1 && !items.parts.empty()) {  // tighter than a box around its spheres
    const Obb box = enclosingObb(items.parts[first]);
    return {{box.center, box.axes}, box};
  }
  return items.withContent(first, count, [&](const Content& content) {
    const ObbFrame frame = oriented ? fitFrame(content, fit) : alignedFrame(content);
    return Framed{frame, enclosingObb(content, frame.axes)};
  });
}

/// Reorders [first, first + count) so that the leaf primitives below the plane come first. Returns
/// the number of leaf primitives below the plane.
std::uint32_t splitAtMean(TreePrimitives& items, std::uint32_t first, std::uint32_t count,
                          const Vec3& mean, const Vec3& normal) {
  std::uint32_t below = first;
  for (std::uint32_t i = first; i < first + count; ++i)
    if (items.side(i, mean, normal) < 0) items.swap(i, below++);
  return below - first;
}

/// Reorders [first, first + count) so that the lower half of the leaf primitives, in the direction
/// of `normal`, comes first. Returns the number of leaf primitives in this half, or 0 if all
/// centroids have the same height along `normal`.
std::uint32_t splitAtMedian(TreePrimitives& items, std::uint32_t first, std::uint32_t count,
                            const Vec3& mean, const Vec3& normal) {
  struct Side {
    double value;
    std::uint32_t item;
  };
  std::vector<Side> sides(count);
  for (std::uint32_t i = 0; i < count; ++i)
    sides[i] = {items.side(first + i, mean, normal), first + i};
  const auto [low, high] = std::ranges::minmax(sides, {}, &Side::value);
  if (!(low.value < high.value)) return 0;
  std::ranges::nth_element(sides, sides.begin() + count / 2, {}, &Side::value);
  // Swaps the leaf primitives that are in the wrong half. Both halves have equally many of these.
  const std::uint32_t half = first + count / 2;
  std::vector<std::uint32_t> up, down;
  for (std::uint32_t i = 0; i < count / 2; ++i)
    if (sides[i].item >= half) down.push_back(sides[i].item);
  for (std::uint32_t i = count / 2; i < count; ++i)
    if (sides[i].item < half) up.push_back(sides[i].item);
  for (std::size_t i = 0; i < up.size(); ++i) items.swap(up[i], down[i]);
  return count / 2;
}

Skeleton topDown(TreePrimitives& items, bool oriented, const TreeParams& params) {
  struct Task {
    std::uint32_t first, count;
    // The parent whose `right` is this node; −1 for the root and for a left child, which follows
    // its parent.
    std::int64_t parent;
  };
  Skeleton nodes;
  nodes.reserve(2 * items.size());
  std::vector<Task> tasks = {{0, items.size(), -1}};
  while (!tasks.empty()) {
    const auto [first, count, parent] = tasks.back();
    tasks.pop_back();
    const auto index = static_cast<std::uint32_t>(nodes.size());
    if (parent >= 0) nodes[static_cast<std::size_t>(parent)].right = index;
    const Framed own = framed(items, first, count, oriented, params.fit);
    nodes.push_back({own.box, first, count, 0});
    if (count == 1) continue;

    std::array<int, 3> order = {0, 1, 2};
    std::ranges::sort(order, std::ranges::greater(), [&](int i) { return own.box.half[i]; });
    for (const int axis : order) {
      const auto split = params.split == SplitRule::mean ? splitAtMean : splitAtMedian;
      const std::uint32_t below =
          split(items, first, count, own.frame.mean, own.frame.axes.col(axis));
      if (below == 0 || below == count) continue;
      tasks.push_back({first + below, count - below, index});
      tasks.push_back({first, below, -1});
      break;
    }
  }
  return nodes;
}

Skeleton bottomUp(TreePrimitives& items, bool oriented, const TreeParams& params) {
  std::vector<Obb> boxes;
  boxes.reserve(items.size());
  for (std::uint32_t i = 0; i < items.size(); ++i)
    boxes.push_back(framingBox(items, i, 1, Mat3::Identity()));
  const std::vector<Cluster> clusters = clustered(boxes);

  struct Task {
    std::uint32_t cluster, first;
    std::int64_t parent;
  };
  Skeleton nodes;
  nodes.reserve(clusters.size());
  std::vector<std::uint32_t> order(items.size());
  std::vector<Task> tasks = {{static_cast<std::uint32_t>(clusters.size() - 1), 0, -1}};
  while (!tasks.empty()) {
    const auto [cluster, first, parent] = tasks.back();
    tasks.pop_back();
    const Cluster& c = clusters[cluster];
    const auto index = static_cast<std::uint32_t>(nodes.size());
    if (parent >= 0) nodes[static_cast<std::size_t>(parent)].right = index;
    nodes.push_back({{}, first, c.count, 0});
    if (c.count == 1) {
      order[first] = cluster;  // clusters [0, n) are the leaf primitives
      continue;
    }
    tasks.push_back({c.right, first + clusters[c.left].count, index});
    tasks.push_back({c.left, first, -1});
  }
  items.reorder(order);
  for (SkeletonNode& node : nodes)
    node.box = framed(items, node.first, node.count, oriented, params.fit).box;
  return nodes;
}

}  // namespace

Obb framingBox(const TreePrimitives& items, std::uint32_t first, std::uint32_t count,
               const Mat3& axes) {
  return items.withContent(first, count,
                           [&](const Content& content) { return enclosingObb(content, axes); });
}

Skeleton buildSkeleton(TreePrimitives& items, bool oriented, const TreeParams& params) {
  return params.building == TreeBuilding::topDown ? topDown(items, oriented, params)
                                                  : bottomUp(items, oriented, params);
}

}  // namespace corridor
