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

#include "collision/hierarchy/primitive_references-inl.h"
#include "collision/volumes/principal_axes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace corridor::HWY_NAMESPACE {

constexpr std::uint32_t kWidth = Obb4Tree::kWidth;
/// If a leaf has several triangles, its box must be flat: its thinnest side is below this share of
/// the middle side. The value is measured.
constexpr float kFlat = 0.6F;
/// A cluster of at most this many triangles is one piece: one thread builds all nodes below it,
/// level by level. The number is large enough to find axes for eight clusters at a time, and small
/// enough for a core's caches.
constexpr std::uint32_t kPiece = 1024;

/// Triangles [first, first + count) with their mean and axes.
struct Cluster {
  std::uint32_t first = 0, count = 0;
  float mean[3] = {};
  float axes[3][3] = {};  // [j][k]: component k of axis j, largest variance first
  float size = 0;         // trace of the summed second moments; the largest cluster is split first
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

/// Data that all threads read, and the records, of which each thread reorders its own range.
struct Shared {
  const TriangleMesh& mesh;
  ObbFit fit;
  double scale;
  std::vector<Vec3> own;  // vertices in the tree's frame and unit
  PrimitiveReferences records;
};

/// Sets the tree's origin and unit. The origin is the middle of the bounds. The unit is the power
/// of two that brings all points into [−1, 1].
void place(const TriangleMesh& mesh, unsigned threads, Obb4Layout& tree) {
  Vec3 lower = mesh.corner(0, 0), upper = lower;
  std::mutex mutex;
  inParts(threads, mesh.triangles.size(), [&](std::size_t begin, std::size_t end) {
    Vec3 low = mesh.corner(begin, 0), high = low;
    for (std::size_t i = begin; i < end; ++i)
      for (const std::uint32_t v : mesh.triangles[i])
        for (int k = 0; k < 3; ++k) {
          const double x = mesh.vertices[v][k];
          low[k] = std::min(low[k], x);
          high[k] = std::max(high[k], x);
        }
    const std::lock_guard lock(mutex);
    lower = lower.cwiseMin(low);
    upper = upper.cwiseMax(high);
  });
  tree.origin = 0.5 * lower + 0.5 * upper;
  const double size = std::max((upper - tree.origin).maxCoeff(), (tree.origin - lower).maxCoeff());
  // Above 2^1000 m some points are outside [−1, 1], and boxes may be too small. No query uses such
  // boxes (`Obb4TreePose`).
  const bool usable = size > 0 && std::isfinite(size);
  tree.length = usable ? std::ldexp(1.0, std::clamp(std::ilogb(size) + 1, -1000, 1000)) : 1;
}

/// Fills the records [begin, end). Returns the largest |p|² of their corners.
double record(Shared& shared, std::size_t begin, std::size_t end) {
  const hn::CappedTag<double, 8> d;
  const hn::Rebind<float, decltype(d)> f;
  using V = hn::Vec<decltype(d)>;
  const auto add3 = [](V a, V b, V c) { return hn::Add(hn::Add(a, b), c); };
  const bool byVertices = shared.fit == ObbFit::vertices;
  V largest = hn::Zero(d);
  for (std::size_t i = begin; i < end; i += 8) {
    const std::size_t count = std::min<std::size_t>(end - i, 8);
    alignas(64) double corner[3][3][8];  // unused lanes repeat the last triangle
    for (std::size_t l = 0; l < 8; ++l) {
      const auto& t = shared.mesh.triangles[i + std::min(l, count - 1)];
      for (int k = 0; k < 3; ++k)
        for (int c = 0; c < 3; ++c) corner[k][c][l] = shared.own[t[k]][c];
    }
    alignas(64) float columns[PrimitiveReferences::kTriangle][8];
    for (std::size_t at = 0; at < 8; at += hn::Lanes(d)) {
      V p[3][3], mean[3];
      for (int k = 0; k < 3; ++k) {
        for (int c = 0; c < 3; ++c) p[k][c] = hn::Load(d, corner[k][c] + at);
        largest = hn::Max(largest, add3(hn::Mul(p[k][0], p[k][0]), hn::Mul(p[k][1], p[k][1]),
                                        hn::Mul(p[k][2], p[k][2])));
      }
      V q[3], r[3];
      for (int c = 0; c < 3; ++c) {
        mean[c] = hn::Mul(add3(p[0][c], p[1][c], p[2][c]), hn::Set(d, 1.0 / 3));
        q[c] = hn::Sub(p[1][c], p[0][c]);
        r[c] = hn::Sub(p[2][c], p[0][c]);
        hn::StoreU(hn::DemoteTo(f, mean[c]), f, columns[PrimitiveReferences::kX + c] + at);
        for (int k = 0; k < 3; ++k) p[k][c] = hn::Sub(p[k][c], mean[c]);
      }
      const V nx = hn::Sub(hn::Mul(q[1], r[2]), hn::Mul(q[2], r[1])),
              ny = hn::Sub(hn::Mul(q[2], r[0]), hn::Mul(q[0], r[2])),
              nz = hn::Sub(hn::Mul(q[0], r[1]), hn::Mul(q[1], r[0]));
      const V area = hn::Mul(hn::Set(d, 0.5),
                             hn::Sqrt(add3(hn::Mul(nx, nx), hn::Mul(ny, ny), hn::Mul(nz, nz))));
      const V weight = byVertices ? hn::Set(d, 1.0) : area;
      hn::StoreU(hn::DemoteTo(f, weight), f, columns[PrimitiveReferences::kWeight] + at);
      // The second moments of a triangle's area have the factor 1/12, those of its corners alone
      // 1/3.
      const V share = hn::Mul(weight, hn::Set(d, byVertices ? 1.0 / 3 : 1.0 / 12));
      int column = PrimitiveReferences::kXX;
      for (int k = 0; k < 3; ++k)
        for (int l = k; l < 3; ++l)
          hn::StoreU(hn::DemoteTo(f, hn::Mul(share, add3(hn::Mul(p[0][k], p[0][l]),
                                                         hn::Mul(p[1][k], p[1][l]),
                                                         hn::Mul(p[2][k], p[2][l])))),
                     f, columns[column++] + at);
    }
    for (int k = 0; k < PrimitiveReferences::kTriangle; ++k)
      std::copy_n(columns[k], count, shared.records.column(k) + i);
    for (std::size_t l = 0; l < count; ++l)
      shared.records.column(PrimitiveReferences::kTriangle)[i + l] =
          std::bit_cast<float>(static_cast<std::uint32_t>(i + l));
  }
  return hn::GetLane(hn::MaxOfLanes(d, largest));
}

/// Builds pieces. There is one worker per thread.
class Worker {
 public:
  struct Task {
    Cluster cluster;
    Piece* piece;
  };

  explicit Worker(Shared& shared) : shared_(shared), spare_(0) {}

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
        const Parts& parts = parts_[i - base];
        for (std::uint32_t lane = 0; lane < kWidth && parts[lane].count > 0; ++lane) {
          const Cluster& part = parts[lane];
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
  /// contains the triangles in real arithmetic.
  void setBox(Obb4Tree::Node& node, std::uint32_t lane, const Cluster& cluster) const {
    const auto& u = cluster.axes;
    alignas(32) double low[4], high[4];
    extents(cluster, low, high);
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
    // differs from it in two ways:
    // * As in `enclosingObb`, |U⁻¹d − Uᵀd| ≤ η·Σ|y|/(1 − 3η) per component, η ≤ 2.1·2^-24 (obb4.h).
    // * y and c are rounded sums of three products of numbers ≤ 1 and ≤ √3, and x itself has two
    //   roundings. Together this is below 16u of double.
    // The last term of the pad covers flush-to-zero: a difference from the origin that is flushed
    // loses less than 2^-1022 m.
    const double pad = 2 * 2.1 * 0x1p-24 * (reach[0] + reach[1] + reach[2]) + 32 * kUnit +
                       0x1p-1020 * shared_.scale;
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
  /// splits the largest of them that is too large for a leaf.
  void divide() {
    parts_.assign(wholes_.size(), {});
    for (std::size_t i = 0; i < wholes_.size(); ++i) parts_[i][0] = wholes_[i];
    for (std::uint32_t count = 1; count < kWidth; ++count) {
      fits_.clear();
      for (Parts& parts : parts_) {
        // The last step found nothing to split, so this step would find nothing either.
        if (parts[count - 1].count == 0) continue;
        // If all clusters are small enough for leaves, they are split further. The lanes would
        // otherwise stay empty, so this costs nothing.
        const bool leavesOnly =
            std::all_of(parts.begin(), parts.begin() + count,
                        [](const Cluster& c) { return c.count <= Obb4Tree::kLeafSize; });
        const std::uint32_t least = leavesOnly ? 1 : Obb4Tree::kLeafSize;
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

  /// Reorders a cluster so that the triangles below a plane through the mean come first. Returns
  /// the number of these triangles. The plane is orthogonal to the axis of largest variance. If
  /// this plane separates nothing, the other axes are tried. If no axis separates anything, the
  /// cluster is cut into halves.
  std::uint32_t split(const Cluster& cluster) {
    for (const auto& n : cluster.axes) {
      const float offset = n[0] * cluster.mean[0] + n[1] * cluster.mean[1] + n[2] * cluster.mean[2];
      const std::size_t below =
          shared_.records.partition(cluster.first, cluster.count, n, offset, spare_);
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
      shared_.records.moments(cluster.first, cluster.count, cluster.mean, m);
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
    if (shared_.fit == ObbFit::hull)
      for (Cluster* cluster : fits_) fitHull(*cluster);
  }

  void fitHull(Cluster& cluster) {
    triangles_.clear();
    for (std::uint32_t i = cluster.first; i < cluster.first + cluster.count; ++i) {
      const auto& t = shared_.mesh.triangles[shared_.records.triangle(i)];
      triangles_.push_back({shared_.own[t[0]], shared_.own[t[1]], shared_.own[t[2]]});
    }
    const ObbFrame frame = fitFrame(triangles_, shared_.fit);
    for (int j = 0; j < 3; ++j) {
      cluster.mean[j] = static_cast<float>(frame.mean[j]);
      for (int k = 0; k < 3; ++k) cluster.axes[j][k] = static_cast<float>(frame.axes(k, j));
    }
  }

  /// Reports whether a cluster becomes a leaf: one triangle, or a few in a flat box. Triangles
  /// around a corner are separated better by boxes of their own.
  static bool isLeaf(const Cluster& cluster, const Obb4Tree::Node& node, std::uint32_t lane) {
    if (cluster.count > Obb4Tree::kLeafSize) return false;
    return cluster.count == 1 || node.half[2][lane] < kFlat * node.half[1][lane];
  }

  /// Computes the least and the largest u_j·x over the corners of a cluster, for each axis u_j.
  void extents(const Cluster& cluster, double (&low)[4], double (&high)[4]) const {
    const hn::CappedTag<double, 4> d;
    alignas(32) double axes[3][4] = {};
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) axes[k][j] = cluster.axes[j][k];
    for (std::size_t at = 0; at < 4; at += hn::Lanes(d)) {
      const auto ux = hn::Load(d, axes[0] + at), uy = hn::Load(d, axes[1] + at),
                 uz = hn::Load(d, axes[2] + at);
      auto lo = hn::Set(d, std::numeric_limits<double>::infinity()), hi = hn::Neg(lo);
      const auto project = [&](const Vec3& p) {
        return hn::Add(hn::Add(hn::Mul(ux, hn::Set(d, p[0])), hn::Mul(uy, hn::Set(d, p[1]))),
                       hn::Mul(uz, hn::Set(d, p[2])));
      };
      for (std::uint32_t i = cluster.first; i < cluster.first + cluster.count; ++i) {
        const auto& t = shared_.mesh.triangles[shared_.records.triangle(i)];
        const auto p = project(shared_.own[t[0]]), q = project(shared_.own[t[1]]),
                   r = project(shared_.own[t[2]]);
        lo = hn::Min(lo, hn::Min(hn::Min(p, q), r));
        hi = hn::Max(hi, hn::Max(hn::Max(p, q), r));
      }
      hn::Store(lo, d, low + at);
      hn::Store(hi, d, high + at);
    }
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

  Shared& shared_;
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

Obb4Layout layOut(const TriangleMesh& mesh, ObbFit fit, unsigned threads) {
  Obb4Layout tree;
  const std::size_t n = mesh.triangles.size();
  place(mesh, threads, tree);
  const double scale = 1 / tree.length;
  Shared shared = {mesh, fit, scale, std::vector<Vec3>(mesh.vertices.size()),
                   PrimitiveReferences(n)};
  inParts(threads, mesh.vertices.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      shared.own[i] = (mesh.vertices[i] - tree.origin) * scale;
  });
  double square = 0;
  std::mutex mutex;
  inParts(threads, n, [&](std::size_t begin, std::size_t end) {
    const double part = record(shared, begin, end);
    const std::lock_guard lock(mutex);
    square = std::max(square, part);
  });
  tree.radius = roundedUp(std::sqrt(square) / scale);

  Piece root;
  {
    Cluster whole = {0, static_cast<std::uint32_t>(n)};
    Worker worker(shared);
    worker.fitAxes(whole);
    Obb4Tree::Node box;
    worker.setBox(box, 0, whole);
    tree.root = boxOf(box, 0);
    const auto share = static_cast<unsigned>(std::min<std::size_t>(threads, n / kPiece + 1));
    runTasks(share, Worker::Task{whole, &root}, [&] { return Worker(shared); });
  }
  tree.nodes = join(root);
  tree.order.resize(n);
  for (std::uint32_t i = 0; i < n; ++i) tree.order[i] = shared.records.triangle(i);
  return tree;
}

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace corridor {

HWY_EXPORT(layOut);

Obb4Layout layOutObb4(const TriangleMesh& mesh, ObbFit fit, unsigned threads) {
  return HWY_DYNAMIC_DISPATCH(layOut)(mesh, fit, threads);
}

}  // namespace corridor
#endif
