#include "collision/hierarchy/obb4_build.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>

#include "collision/core/parallel.h"
#include "collision/core/rounding.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "collision/hierarchy/obb4_build.cpp"
#include "hwy/foreach_target.h"
// Highway requires this include after foreach_target.h.
#include "hwy/highway.h"

#include "collision/hierarchy/obb4_items-inl.h"
#include "collision/volumes/principal_axes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corridor::HWY_NAMESPACE {

constexpr std::uint32_t kWidth = Obb4Tree::kWidth;
/// If a leaf has several triangles, its box must be flat: its thinnest side is below this fraction
/// of the middle side. The value was chosen by measurements.
constexpr float kFlat = 0.6F;
/// A cluster of at most this many leaf primitives is one piece: one thread builds all nodes below
/// it, level by level. The number is large enough to find axes for eight clusters at a time, and
/// small enough for a core's caches.
constexpr std::uint32_t kPiece = 1024;

/// The primitive references [first, first + count), with their mean and axes.
struct Cluster {
  std::uint32_t first = 0, count = 0;
  float mean[3] = {};
  float axes[3][3] = {};  // [j][k]: component k of axis j, largest variance first
  float size = 0;  // trace of the summed second moments; the cluster of largest size is split first
};
using Parts = std::array<Cluster, kWidth>;

/// A piece of the tree: either one node with the pieces below it, or all nodes below a cluster.
/// Nodes are depth first. Children are numbered within the piece.
struct Piece {
  std::vector<Obb4Tree::Node> nodes;
  std::array<std::unique_ptr<Piece>, kWidth> below;
  std::uint32_t at = 0;  // number of its first node in the tree
};

/// Reports whether a child is an inner node, and not a leaf or an empty lane.
bool isNode(std::uint32_t child) {
  return !Obb4Tree::isLeaf(child);
}

/// Builds pieces. There is one worker per thread.
class Worker {
 public:
  struct Task {
    Cluster cluster;
    Piece* piece;
  };

  explicit Worker(BuildItems& items) : items_(items), spare_(0) {}

  /// Builds a piece. If the cluster is too large for one piece, builds only its first node, and
  /// appends the tasks below that node to `more`.
  void operator()(const Task& task, std::vector<Task>& more) {
    wholes_ = {task.cluster};
    nodes_.clear();
    while (!wholes_.empty()) {
      divide();
      const std::size_t base = nodes_.size();
      nodes_.resize(base + wholes_.size());
      wholes_.clear();
      for (std::size_t i = base; i < nodes_.size(); ++i) {
        Obb4Tree::Node& node = nodes_[i];
        std::fill_n(node.child, kWidth, Obb4Tree::kNone);
        Parts& parts = parts_[i - base];
        for (std::uint32_t lane = 0; lane < kWidth && parts[lane].count > 0; ++lane) {
          const Cluster& part = parts[lane];
          if (items_.areParts() && part.count == 1) alignWithPart(parts[lane]);
          setBox(node, lane, part);
          if (isLeaf(part, node, lane)) {
            node.child[lane] = 0x80000000U | part.first << 2 | (part.count - 1);
          } else if (task.cluster.count > kPiece) {
            task.piece->below[lane] = std::make_unique<Piece>();
            more.push_back({part, task.piece->below[lane].get()});
          } else {
            node.child[lane] = static_cast<std::uint32_t>(nodes_.size() + wholes_.size());
            wholes_.push_back(part);
          }
        }
      }
    }
    layDown(task.piece->nodes);
  }

  void fitAxes(Cluster& cluster) {
    fits_ = {&cluster};
    fitAll();
  }

  /// Sets a lane of the node to the smallest box with the cluster's axes, rounded outward. The box
  /// contains the leaf primitives in real arithmetic.
  void setBox(Obb4Tree::Node& node, std::uint32_t lane, const Cluster& cluster) const {
    const auto& u = cluster.axes;
    alignas(32) double low[4], high[4];
    items_.extents(cluster.first, cluster.count, u, low, high);
    double middle[3], reach[3], center[3];
    for (int j = 0; j < 3; ++j) middle[j] = 0.5 * (low[j] + high[j]);
    for (int k = 0; k < 3; ++k)
      center[k] =
          static_cast<float>(u[0][k] * middle[0] + u[1][k] * middle[1] + u[2][k] * middle[2]);
    for (int j = 0; j < 3; ++j) {
      const double c = u[j][0] * center[0] + u[j][1] * center[1] + u[j][2] * center[2];
      reach[j] = std::max(high[j] - c, c - low[j]);
    }
    // The half extents must bound U⁻¹d with d = x − center. The code computes y = Uᵀd, which
    // differs from U⁻¹d in two ways:
    // * As in `enclosingObb`, |U⁻¹d − Uᵀd| ≤ η·Σ|y|/(1 − 3η) per component, η ≤ 2.1·2^-24 (obb4.h).
    // * y and c are rounded sums of three products of numbers ≤ 1 and ≤ √3, and x itself has two
    //   roundings. Together these errors are below 16u, with u of double.
    // The last term of the pad covers flush-to-zero: a difference from the origin that is flushed
    // loses less than 2^-1022 m.
    const double pad = 2 * 2.1 * 0x1p-24 * (reach[0] + reach[1] + reach[2]) + 32 * kUnit +
                       0x1p-1020 * items_.scale;
    // The longest side comes first, so that this side alone gives the size of a box.
    int order[3] = {0, 1, 2};
    if (reach[order[0]] < reach[order[1]]) std::swap(order[0], order[1]);
    if (reach[order[1]] < reach[order[2]]) std::swap(order[1], order[2]);
    if (reach[order[0]] < reach[order[1]]) std::swap(order[0], order[1]);
    for (int j = 0; j < 3; ++j) {
      node.vectors[j][Obb4::kCenter][lane] = static_cast<float>(center[j]);
      // The factor rounds up to a float: half an ulp is at most 2^-24 of the value, which is not
      // subnormal.
      node.half[j][lane] = static_cast<float>((reach[order[j]] + pad) * (1 + 0x1p-23));
      for (int k = 0; k < 3; ++k) node.vectors[k][j][lane] = u[order[j]][k];
    }
  }

 private:
  /// Divides each cluster of `wholes_` into at most four clusters and finds their axes. Each step
  /// splits the largest cluster among those that are too large for a leaf. If there are none, it
  /// splits the largest of all.
  void divide() {
    parts_.assign(wholes_.size(), {});
    for (std::size_t i = 0; i < wholes_.size(); ++i) parts_[i][0] = wholes_[i];
    for (std::uint32_t count = 1; count < kWidth; ++count) {
      fits_.clear();
      for (Parts& parts : parts_) {
        // The last step found no cluster to split, so this step would find none either.
        if (parts[count - 1].count == 0) continue;
        // If all clusters are small enough for leaves, they are split further. This costs no
        // memory, because the lanes would otherwise stay empty.
        const bool leavesOnly =
            std::all_of(parts.begin(), parts.begin() + count,
                        [&](const Cluster& c) { return c.count <= items_.mostPerLeaf(); });
        const std::uint32_t least = leavesOnly ? 1 : items_.mostPerLeaf();
        std::uint32_t best = count;
        for (std::uint32_t i = 0; i < count; ++i)
          if (parts[i].count > least && (best == count || parts[i].size > parts[best].size))
            best = i;
        if (best == count) continue;
        const Cluster& parent = parts[best];
        const std::uint32_t below = split(parent);
        parts[count].first = parent.first + below;
        parts[count].count = parent.count - below;
        parts[best].count = below;
        fits_.push_back(&parts[best]);
        fits_.push_back(&parts[count]);
      }
      fitAll();
    }
  }

  /// Reorders a cluster so that the leaf primitives below a plane through the mean come first.
  /// Returns their number. The plane is orthogonal to the axis of largest variance. If this plane
  /// separates nothing, the other axes are tried. If no axis separates anything, the cluster is cut
  /// into halves.
  std::uint32_t split(const Cluster& cluster) {
    for (const auto& n : cluster.axes) {
      const float offset = n[0] * cluster.mean[0] + n[1] * cluster.mean[1] + n[2] * cluster.mean[2];
      const std::size_t below =
          items_.records.partition(cluster.first, cluster.count, n, offset, spare_);
      if (below > 0 && below < cluster.count) return static_cast<std::uint32_t>(below);
    }
    return cluster.count / 2;
  }

  /// Computes mean, axes and size of all clusters in `fits_`.
  void fitAll() {
    covariances_.resize((fits_.size() + 7) / 8);
    for (std::size_t i = 0; i < fits_.size(); ++i) {
      Cluster& cluster = *fits_[i];
      double m[6];
      items_.records.moments(cluster.first, cluster.count, cluster.mean, m);
      cluster.size = static_cast<float>(m[0] + m[3] + m[5]);
      for (int k = 0; k < 6; ++k) covariances_[i / 8].entry[k][i % 8] = m[k];
    }
    for (std::size_t i = 0; i < fits_.size(); i += 8) {
      Axes8 found;
      principalAxes8(covariances_[i / 8], found);
      for (std::size_t l = 0; l < std::min<std::size_t>(fits_.size() - i, 8); ++l)
        for (int j = 0; j < 3; ++j)
          for (int k = 0; k < 3; ++k)
            fits_[i + l]->axes[j][k] = static_cast<float>(found.axes[j][k][l]);
    }
    if (items_.fit == ObbFit::hull)
      for (Cluster* cluster : fits_) fitHull(*cluster);
  }

  void fitHull(Cluster& cluster) {
    triangles_.clear();
    for (std::uint32_t i = cluster.first; i < cluster.first + cluster.count; ++i)
      triangles_.push_back(items_.triangle(i));
    const ObbFrame frame = fitFrame(triangles_, items_.fit);
    for (int j = 0; j < 3; ++j) {
      cluster.mean[j] = static_cast<float>(frame.mean[j]);
      for (int k = 0; k < 3; ++k) cluster.axes[j][k] = static_cast<float>(frame.axes(k, j));
    }
  }

  /// Gives the cluster of one part the axes of the part's own box. A ball keeps its axes.
  void alignWithPart(Cluster& cluster) const {
    const ConvexPart& part = items_.part(cluster.first);
    if (part.points.size() < 2) return;  // a ball
    const Obb box = enclosingObb(part);
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) cluster.axes[j][k] = static_cast<float>(box.axes(k, j));
  }

  /// Reports whether a cluster becomes a leaf: it has one leaf primitive, or a few triangles in a
  /// flat box. Triangles around a corner are separated better by boxes of their own.
  bool isLeaf(const Cluster& cluster, const Obb4Tree::Node& node, std::uint32_t lane) const {
    if (cluster.count > items_.mostPerLeaf()) return false;
    return cluster.count == 1 || node.half[2][lane] < kFlat * node.half[1][lane];
  }

  /// Copies `nodes_` to `nodes`, in depth-first order.
  void layDown(std::vector<Obb4Tree::Node>& nodes) const {
    struct Item {
      std::uint32_t node, parent, lane;
    };
    nodes.reserve(nodes_.size());
    std::vector<Item> stack = {{0, 0, 0}};
    while (!stack.empty()) {
      const Item item = stack.back();
      stack.pop_back();
      const auto at = static_cast<std::uint32_t>(nodes.size());
      if (at > 0) nodes[item.parent].child[item.lane] = at;
      nodes.push_back(nodes_[item.node]);
      for (std::uint32_t lane = kWidth; lane-- > 0;)
        if (const std::uint32_t child = nodes_[item.node].child[lane]; isNode(child))
          stack.push_back({child, at, lane});
    }
  }

  BuildItems& items_;
  PrimitiveReferences spare_;
  std::vector<Obb4Tree::Node> nodes_;  // the nodes of the current piece, level by level
  std::vector<Cluster> wholes_;
  std::vector<Parts> parts_;
  std::vector<Cluster*> fits_;
  std::vector<Covariances8> covariances_;
  std::vector<Triangle> triangles_;  // triangles of one cluster
};

/// Joins a piece and all pieces below it into one list, in depth-first order.
std::vector<Obb4Tree::Node> join(Piece& root) {
  if (std::none_of(root.below.begin(), root.below.end(), [](const auto& p) { return bool(p); }))
    return std::move(root.nodes);
  std::vector<Piece*> pieces, stack = {&root};
  std::uint32_t count = 0;
  while (!stack.empty()) {
    Piece* const piece = stack.back();
    stack.pop_back();
    pieces.push_back(piece);
    piece->at = count;
    count += static_cast<std::uint32_t>(piece->nodes.size());
    for (std::uint32_t lane = kWidth; lane-- > 0;)
      if (piece->below[lane]) stack.push_back(piece->below[lane].get());
  }
  std::vector<Obb4Tree::Node> nodes;
  nodes.reserve(count);
  for (const Piece* piece : pieces)
    for (Obb4Tree::Node node : piece->nodes) {
      for (std::uint32_t lane = 0; lane < kWidth; ++lane)
        if (piece->below[lane]) {
          node.child[lane] = piece->below[lane]->at;
        } else if (isNode(node.child[lane])) {
          node.child[lane] += piece->at;
        }
      nodes.push_back(node);
    }
  return nodes;
}

Obb4Layout layOut(BuildItems& items, unsigned threads) {
  Obb4Layout tree;
  tree.frame = {items.origin, items.length, items.radius};
  const std::size_t n = items.size();
  Piece root;
  {
    Cluster whole = {0, static_cast<std::uint32_t>(n)};
    Worker worker(items);
    worker.fitAxes(whole);
    Obb4Tree::Node box;
    worker.setBox(box, 0, whole);
    tree.root = boxOf(box, 0);
    const auto share = static_cast<unsigned>(std::min<std::size_t>(threads, n / kPiece + 1));
    runTasks(share, Worker::Task{whole, &root}, [&] { return Worker(items); });
  }
  tree.nodes = join(root);
  tree.order.resize(n);
  for (std::uint32_t i = 0; i < n; ++i) tree.order[i] = items.number(i);
  return tree;
}

Obb4Layout layOutMesh(const TriangleMesh& mesh, ObbFit fit, unsigned threads) {
  BuildItems items(mesh, fit, threads);
  return layOut(items, threads);
}

Obb4Layout layOutParts(std::span<const ConvexPart> parts, unsigned threads) {
  BuildItems items(parts, threads);
  return layOut(items, threads);
}

Obb4Frame refit(const TriangleMesh& moved, std::span<const std::uint32_t> order, Obb1& root,
                std::span<Obb4Tree::Node> nodes) {
  BuildItems items(moved, order);
  const Worker worker(items);
  // A node is numbered before all nodes below it, and its triangles are a range in leaf order.
  std::vector<Cluster> ranges(nodes.size());
  for (std::size_t i = nodes.size(); i-- > 0;) {
    Obb4Tree::Node& node = nodes[i];
    std::uint32_t first = std::numeric_limits<std::uint32_t>::max(), count = 0;
    for (std::uint32_t lane = 0; lane < kWidth; ++lane) {
      const std::uint32_t child = node.child[lane];
      if (child == Obb4Tree::kNone) continue;
      Cluster part = isNode(child)
                         ? ranges[child]
                         : Cluster{Obb4Tree::leafFirst(child), Obb4Tree::leafCount(child)};
      for (int j = 0; j < 3; ++j)
        for (int k = 0; k < 3; ++k) part.axes[j][k] = node.vectors[k][j][lane];
      worker.setBox(node, lane, part);
      first = std::min(first, part.first);
      count += part.count;
    }
    ranges[i] = {first, count};
  }
  Cluster whole = {0, static_cast<std::uint32_t>(order.size())};
  for (int j = 0; j < 3; ++j)
    for (int k = 0; k < 3; ++k) whole.axes[j][k] = root.vectors[k][j];
  Obb4Tree::Node box;
  worker.setBox(box, 0, whole);
  root = boxOf(box, 0);
  return {items.origin, items.length, items.radius};
}

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corridor {

HWY_EXPORT(layOutMesh);
HWY_EXPORT(layOutParts);
HWY_EXPORT(refit);

Obb4Layout layOutObb4(const TriangleMesh& mesh, ObbFit fit, unsigned threads) {
  return HWY_DYNAMIC_DISPATCH(layOutMesh)(mesh, fit, threads);
}

Obb4Layout layOutObb4(std::span<const ConvexPart> parts, unsigned threads) {
  return HWY_DYNAMIC_DISPATCH(layOutParts)(parts, threads);
}

Obb4Frame refitObb4(const TriangleMesh& moved, std::span<const std::uint32_t> order, Obb1& root,
                    std::span<Obb4Tree::Node> nodes) {
  return HWY_DYNAMIC_DISPATCH(refit)(moved, order, root, nodes);
}

}  // namespace corridor
#endif
