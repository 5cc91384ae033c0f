#include "collision/hierarchy/wide_obb_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <Eigen/Geometry>

#include "collision/core/rounding.h"
#include "collision/volumes/moments.h"
#include "collision/volumes/obb.h"

namespace corridor {
namespace {

/// What a split needs to know of a triangle, in the tree's frame and unit. Second moments are about
/// the triangle's own centroid, so that sums over few and small triangles far from the origin don't
/// cancel (numerics: moments).
struct Record {
  std::array<float, 3> centroid;
  float weight;                 // the area
  std::array<float, 6> spread;  // weight · covariance: xx, xy, xz, yy, yz, zz
  std::uint32_t triangle;
};

/// Triangles [first, first + count) with their mean and axes.
struct Cluster {
  std::uint32_t first = 0, count = 0;
  Vec3 mean = Vec3::Zero();
  Mat3 axes = Mat3::Identity();  // columns, largest variance first
  double size = 0;               // trace of the covariance sum: what a split would gain
};

}  // namespace

/// Builds one tree; its scratch memory goes with it.
class WideObbBuilder {
 public:
  WideObbBuilder(WideObbTree& tree, const TriangleMesh& mesh, ObbFit fit)
      : tree_(tree), mesh_(mesh), fit_(fit) {}

  void build() {
    if (mesh_.triangles.size() >= (1U << 29) - 1)
      throw std::length_error("a tree holds less than 2^29 triangles");
    tree_.vertices_ = mesh_.vertices;
    place();
    record();
    const auto n = static_cast<std::uint32_t>(records_.size());
    tree_.nodes_.reserve(n / 6 + 4);
    Cluster root{0, n};
    fitAxes(root);
    struct Task {
      Cluster cluster;
      std::uint32_t node, lane;  // whose child it becomes
    };
    std::vector<Task> tasks = {{root, WideObbTree::kNone, 0}};
    while (!tasks.empty()) {
      const Task task = tasks.back();
      tasks.pop_back();
      const bool isRoot = task.node == WideObbTree::kNone;
      if (!isRoot && isLeaf(task.cluster, tree_.nodes_[task.node], task.lane)) {
        tree_.nodes_[task.node].child[task.lane] =
            0x80000000U | task.cluster.first << 2 | (task.cluster.count - 1);
        continue;
      }
      const auto index = static_cast<std::uint32_t>(tree_.nodes_.size());
      if (!isRoot) tree_.nodes_[task.node].child[task.lane] = index;
      tree_.nodes_.emplace_back();
      clear(tree_.nodes_[index]);
      std::array<Cluster, WideObbTree::kWidth> parts;
      const std::uint32_t count = divide(task.cluster, parts);
      for (std::uint32_t lane = count; lane-- > 0;) {
        setBox(index, lane, parts[lane]);
        tasks.push_back({parts[lane], index, lane});
      }
    }
    tree_.nodes_.shrink_to_fit();
    finish();
  }

 private:
  using Four = Eigen::Array<double, 4, 1>;

  /// Origin and unit: the middle of the bounds, and the power of two that brings all into [−1, 1].
  void place() {
    Vec3 lower = mesh_.corner(0, 0), upper = lower;
    for (const auto& t : mesh_.triangles)
      for (const std::uint32_t v : t) {
        lower = lower.cwiseMin(mesh_.vertices[v]);
        upper = upper.cwiseMax(mesh_.vertices[v]);
      }
    tree_.origin_ = 0.5 * lower + 0.5 * upper;
    const double size =
        std::max((upper - tree_.origin_).maxCoeff(), (tree_.origin_ - lower).maxCoeff());
    // Sizes that overflow give boxes that overlap everything, not wrong ones.
    tree_.unit_ = size > 0 && std::isfinite(size) ? std::ilogb(size) + 1 : 0;
    scale_ = std::ldexp(1.0, -std::clamp(tree_.unit_, -1000, 1000));
    tree_.unit_ = std::clamp(tree_.unit_, -1000, 1000);
    tree_.length_ = std::ldexp(1.0, tree_.unit_);
    double radius = 0;
    for (const auto& t : mesh_.triangles)
      for (const std::uint32_t v : t)
        radius = std::max(radius, (mesh_.vertices[v] - tree_.origin_).stableNorm());
    tree_.radius_ = roundedUp(radius);
    tree_.reach_ = roundedUp(tree_.origin_.stableNorm() + tree_.radius_);
  }

  void record() {
    own_.reserve(tree_.vertices_.size());
    for (const Vec3& v : tree_.vertices_) own_.emplace_back((v - tree_.origin_) * scale_);
    records_.resize(mesh_.triangles.size());
    for (std::uint32_t i = 0; i < records_.size(); ++i) {
      const auto& t = mesh_.triangles[i];
      const Vec3 p = own_[t[0]], q = own_[t[1]], r = own_[t[2]];
      const Vec3 c = (p + q + r) / 3;
      const double area = 0.5 * (q - p).cross(r - p).norm();
      Record& record = records_[i];
      record.triangle = i;
      const double weight = fit_ == ObbFit::vertices ? 1 : area;
      record.weight = static_cast<float>(weight);
      const Vec3 a = p - c, b = q - c, d = r - c;
      // Of a triangle's points, or of its corners alone.
      const double w = weight / (fit_ == ObbFit::vertices ? 3 : 12);
      int at = 0;
      for (int k = 0; k < 3; ++k) {
        record.centroid[k] = static_cast<float>(c[k]);
        for (int l = k; l < 3; ++l)
          record.spread[at++] = static_cast<float>(w * (a[k] * a[l] + b[k] * b[l] + d[k] * d[l]));
      }
    }
  }

  /// Mean, axes and size of a cluster.
  void fitAxes(Cluster& cluster) {
    const Record* const begin = records_.data() + cluster.first;
    const Record* const end = begin + cluster.count;
    double weight = 0, mx = 0, my = 0, mz = 0;
    for (const Record* r = begin; r != end; ++r) {
      const double w = r->weight;
      weight += w;
      mx += w * r->centroid[0];
      my += w * r->centroid[1];
      mz += w * r->centroid[2];
    }
    const bool flat = !(weight > 0x1p-100);  // no area at all: all triangles alike
    if (flat) {
      weight = cluster.count;
      mx = my = mz = 0;
      for (const Record* r = begin; r != end; ++r) {
        mx += r->centroid[0];
        my += r->centroid[1];
        mz += r->centroid[2];
      }
    }
    cluster.mean = Vec3(mx, my, mz) / weight;
    const auto x0 = static_cast<float>(cluster.mean[0]), y0 = static_cast<float>(cluster.mean[1]),
               z0 = static_cast<float>(cluster.mean[2]);
    float xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
    for (const Record* r = begin; r != end; ++r) {
      const float w = flat ? 1.0F : r->weight;
      const float x = r->centroid[0] - x0, y = r->centroid[1] - y0, z = r->centroid[2] - z0;
      const float wx = w * x, wy = w * y, wz = w * z;
      xx += wx * x + r->spread[0];
      xy += wx * y + r->spread[1];
      xz += wx * z + r->spread[2];
      yy += wy * y + r->spread[3];
      yz += wy * z + r->spread[4];
      zz += wz * z + r->spread[5];
    }
    cluster.size = static_cast<double>(xx) + yy + zz;
    Mat3 c;
    c << xx, xy, xz, xy, yy, yz, xz, yz, zz;
    if (fit_ == ObbFit::hull) return fitHull(cluster);
    cluster.axes = principalAxes(c);
  }

  void fitHull(Cluster& cluster) {
    triangles_.clear();
    for (std::uint32_t i = cluster.first; i < cluster.first + cluster.count; ++i) {
      const auto& t = mesh_.triangles[records_[i].triangle];
      triangles_.push_back({own_[t[0]], own_[t[1]], own_[t[2]]});
    }
    const ObbFrame frame = fitFrame(triangles_, fit_);
    cluster.mean = frame.mean;
    cluster.axes = frame.axes;
  }

  /// Parts of a cluster, at most eight, each with its axes: always the largest that is no leaf yet
  /// is split in two.
  std::uint32_t divide(const Cluster& whole, std::array<Cluster, WideObbTree::kWidth>& parts) {
    parts[0] = whole;
    std::uint32_t count = 1;
    while (count < WideObbTree::kWidth) {
      // Boxes cost nothing where lanes are left: then leaves are split, too.
      const bool leavesOnly =
          std::all_of(parts.begin(), parts.begin() + count,
                      [](const Cluster& c) { return c.count <= WideObbTree::kLeafSize; });
      const std::uint32_t least = leavesOnly ? 1 : WideObbTree::kLeafSize;
      std::uint32_t best = count;
      for (std::uint32_t i = 0; i < count; ++i)
        if (parts[i].count > least && (best == count || parts[i].size > parts[best].size)) best = i;
      if (best == count) break;
      const Cluster parent = parts[best];
      const std::uint32_t below = split(parent);
      parts[best] = {parent.first, below};
      parts[count] = {parent.first + below, parent.count - below};
      fitAxes(parts[best]);
      fitAxes(parts[count++]);
    }
    return count;
  }

  /// Reorders a cluster so that the triangles below the plane come first; returns how many: by the
  /// longest axis, or the others, and where no plane through the mean parts them, in halves.
  std::uint32_t split(const Cluster& cluster) {
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 n = cluster.axes.col(axis);
      const auto nx = static_cast<float>(n[0]), ny = static_cast<float>(n[1]),
                 nz = static_cast<float>(n[2]);
      const auto offset = static_cast<float>(n.dot(cluster.mean));
      Record* const begin = records_.data() + cluster.first;
      Record* const middle = std::partition(begin, begin + cluster.count, [&](const Record& r) {
        return nx * r.centroid[0] + ny * r.centroid[1] + nz * r.centroid[2] < offset;
      });
      if (middle != begin && middle != begin + cluster.count)
        return static_cast<std::uint32_t>(middle - begin);
    }
    return cluster.count / 2;
  }

  /// Few triangles, in a box that is flat: those around a corner are better told apart by boxes of
  /// their own.
  static bool isLeaf(const Cluster& cluster, const WideObbTree::Node& node, std::uint32_t lane) {
    if (cluster.count > WideObbTree::kLeafSize) return false;
    return cluster.count == 1 || node.half[2][lane] < kFlat * node.half[1][lane];
  }

  static void clear(WideObbTree::Node& node) {
    node = {};
    std::fill_n(node.child, WideObbTree::kWidth, WideObbTree::kNone);
  }

  /// (Not `m.cast<float>().cast<double>()`: g++ 12 at -O2 makes nothing of Eigen's vectorised pair
  /// of casts.)
  static double asFloat(double x) { return static_cast<float>(x); }

  static float up(double x) {
    const auto f = static_cast<float>(x);
    return f < x ? std::nextafterf(f, std::numeric_limits<float>::infinity()) : f;
  }

  /// The smallest box with these axes, rounded outward: contains the triangles in real arithmetic.
  void setBox(std::uint32_t index, std::uint32_t lane, const Cluster& cluster) {
    // The axes as they are stored.
    const Mat3 u = cluster.axes.unaryExpr(&asFloat);
    // Four components, the last unused: two SIMD registers, in any instruction set.
    const Four ux(u(0, 0), u(0, 1), u(0, 2), 0), uy(u(1, 0), u(1, 1), u(1, 2), 0),
        uz(u(2, 0), u(2, 1), u(2, 2), 0);
    Four lo = Four::Constant(std::numeric_limits<double>::infinity()), hi = -lo;
    for (std::uint32_t i = cluster.first; i < cluster.first + cluster.count; ++i)
      for (const std::uint32_t v : mesh_.triangles[records_[i].triangle]) {
        const Vec3& x = own_[v];
        const Four y = ux * x[0] + uy * x[1] + uz * x[2];
        lo = lo.min(y);
        hi = hi.max(y);
      }
    Vec3 middle = Vec3::Zero();
    for (int k = 0; k < 3; ++k) middle += u.col(k) * (0.5 * (lo[k] + hi[k]));
    const Vec3 center = middle.unaryExpr(&asFloat);
    double reach[3];
    for (int k = 0; k < 3; ++k) {
      const double c = u.col(k).dot(center);
      reach[k] = std::max(hi[k] - c, c - lo[k]);
    }
    // Wanted is U⁻¹d, d = x − center; known is y = Uᵀd up to rounding. As in `enclosingObb`:
    // |U⁻¹d − Uᵀd| ≤ η·Σ|y|/(1 − 3η) per component. Rounding: y and c are sums of three products of
    // numbers ≤ 1 and ≤ √3 and x itself has two roundings, together under 16u of double; a power of
    // two's scaling that underflows loses less than 2^-1000.
    const double pad = 2 * orthonormalityDefect(u) * (reach[0] + reach[1] + reach[2]) + 32 * kUnit +
                       0x1p-1020 * scale_;
    // Longest side first: who compares sizes of boxes reads one number.
    std::array<int, 3> order = {0, 1, 2};
    std::sort(order.begin(), order.end(), [&](int i, int j) { return reach[i] > reach[j]; });
    WideObbTree::Node& node = tree_.nodes_[index];
    for (int j = 0; j < 3; ++j) {
      node.vectors[j][Obb4::kCenter][lane] = static_cast<float>(center[j]);
      node.half[j][lane] = up(reach[order[j]] + pad);
      for (int k = 0; k < 3; ++k) node.vectors[k][j][lane] = static_cast<float>(u(k, order[j]));
    }
  }

  /// Triangles in leaf order.
  void finish() {
    tree_.triangles_.resize(records_.size());
    tree_.meshTriangle_.resize(records_.size());
    for (std::uint32_t i = 0; i < records_.size(); ++i) {
      tree_.triangles_[i] = mesh_.triangles[records_[i].triangle];
      tree_.meshTriangle_[i] = records_[i].triangle;
    }
  }

  static constexpr float kFlat = 0.6F;

  WideObbTree& tree_;
  const TriangleMesh& mesh_;
  ObbFit fit_;
  std::vector<Vec3> own_;  // vertices in the tree's frame and unit
  std::vector<Record> records_;
  std::vector<Triangle> triangles_;  // of one cluster
  double scale_ = 1;
};

WideObbTree::WideObbTree(const TriangleMesh& mesh, ObbFit fit) {
  WideObbBuilder(*this, mesh, fit).build();
}

std::size_t WideObbTree::bytes() const {
  return sizeof(*this) + nodes_.capacity() * sizeof(Node) + vertices_.capacity() * sizeof(Vec3) +
         triangles_.capacity() * sizeof(triangles_[0]) +
         meshTriangle_.capacity() * sizeof(std::uint32_t);
}

}  // namespace corridor
