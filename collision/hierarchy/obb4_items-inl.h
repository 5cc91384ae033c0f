// The leaf primitives over which a 4-wide OBB tree is built. Included once per SIMD target by
// foreach_target.h.

// clang-format off
#if defined(CORRIDOR_OBB4_ITEMS_INL_H_) == defined(HWY_TARGET_TOGGLE)  // Highway's include guard
#ifdef CORRIDOR_OBB4_ITEMS_INL_H_
#undef CORRIDOR_OBB4_ITEMS_INL_H_
#else
#define CORRIDOR_OBB4_ITEMS_INL_H_
#endif
// clang-format on

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <mutex>
#include <span>
#include <vector>

#include "hwy/highway.h"

#include "collision/core/parallel.h"
#include "collision/core/rounding.h"
#include "collision/hierarchy/obb4_build.h"
#include "collision/hierarchy/primitive_references-inl.h"
#include "collision/volumes/part_obb.h"

HWY_BEFORE_NAMESPACE();
namespace corridor::HWY_NAMESPACE {

/// The leaf primitives of a tree while it is built: the triangles of a mesh, or convex parts. Their
/// points are in the tree's frame and unit. Parts are replaced by balls whose hull contains them.
///
/// All threads read the points. The records are reordered: each thread reorders its own range.
class BuildItems {
 public:
  BuildItems(const TriangleMesh& mesh, ObbFit itsFit, unsigned threads)
      : fit(itsFit), records(mesh.triangles.size()), mesh_(&mesh) {
    place(threads, [&](std::size_t i, const auto& take) {
      for (const std::uint32_t v : mesh.triangles[i]) take(mesh.vertices[v], 0.0);
    });
    own_.resize(mesh.vertices.size());
    inParts(threads, mesh.vertices.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) own_[i] = (mesh.vertices[i] - origin) * scale;
    });
    record(threads,
           [&](std::size_t begin, std::size_t end) { return recordTriangles(begin, end); });
  }

  BuildItems(std::span<const ConvexPart> parts, unsigned threads)
      : fit(ObbFit::triangles), records(parts.size()), parts_(parts) {
    std::vector<Ball> balls;
    first_.reserve(parts.size() + 1);
    for (const ConvexPart& part : parts) {
      first_.push_back(balls.size());
      addBallsOf(part, balls);
    }
    first_.push_back(balls.size());
    place(threads, [&](std::size_t i, const auto& take) {
      for (std::size_t k = first_[i]; k < first_[i + 1]; ++k)
        take(balls[k].center, balls[k].radius);
    });
    own_.resize(balls.size());
    radii_.resize(balls.size());
    for (std::size_t k = 0; k < balls.size(); ++k) {
      own_[k] = (balls[k].center - origin) * scale;
      radii_[k] = balls[k].radius * scale;
    }
    std::vector<Ball>().swap(balls);  // frees the memory before the tree is built
    record(threads, [&](std::size_t begin, std::size_t end) { return recordParts(begin, end); });
  }

  /// Takes the triangles of a tree that is refitted, in the tree's leaf order. The records have the
  /// numbers of the triangles and nothing else.
  BuildItems(const TriangleMesh& mesh, std::span<const std::uint32_t> order)
      : fit(ObbFit::triangles), records(order.size()), mesh_(&mesh) {
    place(1, [&](std::size_t i, const auto& take) {
      for (const std::uint32_t v : mesh.triangles[i]) take(mesh.vertices[v], 0.0);
    });
    own_.reserve(mesh.vertices.size());
    for (const Vec3& v : mesh.vertices) own_.emplace_back((v - origin) * scale);
    record(1, [&](std::size_t begin, std::size_t end) {
      double largest = 0;
      for (std::size_t i = begin; i < end; ++i) {
        records.column(PrimitiveReferences::kTriangle)[i] = std::bit_cast<float>(order[i]);
        for (const std::uint32_t v : mesh.triangles[i])
          largest = std::max(largest, own_[v].squaredNorm());
      }
      return largest;
    });
  }

  std::size_t size() const { return mesh_ ? mesh_->triangles.size() : parts_.size(); }
  bool areParts() const { return mesh_ == nullptr; }
  /// The largest number of leaf primitives in a leaf. A test of two parts costs more than sixteen
  /// tests of boxes, so each part has a box of its own.
  std::uint32_t mostPerLeaf() const { return areParts() ? 1 : Obb4Tree::kLeafSize; }
  /// Returns the number of the leaf primitive of the i-th record.
  std::uint32_t number(std::size_t i) const { return records.triangle(i); }
  Triangle triangle(std::size_t i) const {
    const auto& t = mesh_->triangles[number(i)];
    return {own_[t[0]], own_[t[1]], own_[t[2]]};
  }
  const ConvexPart& part(std::size_t i) const { return parts_[number(i)]; }

  /// Computes the least and the largest u_j·x over the leaf primitives of the records [first, first
  /// + count), for each axis u_j, |u_j| ≤ 1 + 2^-23. For balls, the values are rounded outward.
  void extents(std::size_t first, std::size_t count, const float (&u)[3][3], double (&low)[4],
               double (&high)[4]) const {
    const hn::CappedTag<double, 4> d;
    alignas(32) double axes[3][4] = {};
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) axes[k][j] = u[j][k];
    for (std::size_t at = 0; at < 4; at += hn::Lanes(d)) {
      const auto ux = hn::Load(d, axes[0] + at), uy = hn::Load(d, axes[1] + at),
                 uz = hn::Load(d, axes[2] + at);
      auto lo = hn::Set(d, std::numeric_limits<double>::infinity()), hi = hn::Neg(lo);
      const auto project = [&](const Vec3& p) {
        return hn::Add(hn::Add(hn::Mul(ux, hn::Set(d, p[0])), hn::Mul(uy, hn::Set(d, p[1]))),
                       hn::Mul(uz, hn::Set(d, p[2])));
      };
      for (std::size_t i = first; i < first + count; ++i) {
        if (areParts()) {
          for (std::size_t k = first_[number(i)]; k < first_[number(i) + 1]; ++k) {
            // Along u, a ball reaches r|u| ≤ r(1 + 2^-23).
            const auto p = project(own_[k]), r = hn::Set(d, radii_[k] * (1 + 0x1p-22));
            lo = hn::Min(lo, hn::Sub(p, r));
            hi = hn::Max(hi, hn::Add(p, r));
          }
          continue;
        }
        const auto& t = mesh_->triangles[number(i)];
        const auto p = project(own_[t[0]]), q = project(own_[t[1]]), r = project(own_[t[2]]);
        lo = hn::Min(lo, hn::Min(hn::Min(p, q), r));
        hi = hn::Max(hi, hn::Max(hn::Max(p, q), r));
      }
      hn::Store(lo, d, low + at);
      hn::Store(hi, d, high + at);
    }
  }

  ObbFit fit;
  Vec3 origin = Vec3::Zero();
  double length = 1, scale = 1;  ///< the tree's unit in metres, and its reciprocal
  double radius = 0;  ///< largest distance of a point from the origin, metres, rounded up
  PrimitiveReferences records;

 private:
  /// Sets origin, length and scale. The origin is the middle of the bounds. The unit is the power
  /// of two that brings all points into [−1, 1].
  template <class Each>
  void place(unsigned threads, const Each& each) {
    Vec3 lower = Vec3::Constant(std::numeric_limits<double>::infinity()), upper = -lower;
    std::mutex mutex;
    inParts(threads, size(), [&](std::size_t begin, std::size_t end) {
      Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
      for (std::size_t i = begin; i < end; ++i)
        each(i, [&](const Vec3& p, double r) {
          for (int k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], p[k] - r);
            high[k] = std::max(high[k], p[k] + r);
          }
        });
      const std::lock_guard lock(mutex);
      lower = lower.cwiseMin(low);
      upper = upper.cwiseMax(high);
    });
    origin = 0.5 * lower + 0.5 * upper;
    double most = std::max((upper - origin).maxCoeff(), (origin - lower).maxCoeff());
    // For balls, p ± r and the two differences above have rounding errors of at most 4u times the
    // largest coordinate.
    if (areParts()) most += 4 * kUnit * (upper.cwiseAbs() + lower.cwiseAbs()).maxCoeff();
    // Above 2^1000 m some points are outside [−1, 1], and boxes may be too small. No query uses
    // such boxes (`Obb4TreePose`).
    const bool usable = most > 0 && std::isfinite(most);
    length = usable ? std::ldexp(1.0, std::clamp(std::ilogb(most) + 1, -1000, 1000)) : 1;
    scale = 1 / length;
  }

  /// Fills the records [begin, end) of triangles. Returns the largest |p|² of their corners.
  double recordTriangles(std::size_t begin, std::size_t end) {
    const hn::CappedTag<double, 8> d;
    const hn::Rebind<float, decltype(d)> f;
    using V = hn::Vec<decltype(d)>;
    const auto add3 = [](V a, V b, V c) { return hn::Add(hn::Add(a, b), c); };
    const bool byVertices = fit == ObbFit::vertices;
    V largest = hn::Zero(d);
    for (std::size_t i = begin; i < end; i += 8) {
      const std::size_t count = std::min<std::size_t>(end - i, 8);
      alignas(64) double corner[3][3][8];  // unused lanes repeat the last triangle
      for (std::size_t l = 0; l < 8; ++l) {
        const auto& t = mesh_->triangles[i + std::min(l, count - 1)];
        for (int k = 0; k < 3; ++k)
          for (int c = 0; c < 3; ++c) corner[k][c][l] = own_[t[k]][c];
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
        std::copy_n(columns[k], count, records.column(k) + i);
      for (std::size_t l = 0; l < count; ++l)
        records.column(PrimitiveReferences::kTriangle)[i + l] =
            std::bit_cast<float>(static_cast<std::uint32_t>(i + l));
    }
    return hn::GetLane(hn::MaxOfLanes(d, largest));
  }

  /// Fills the records [begin, end) of convex parts. Returns the largest (|p| + r)² of their balls.
  double recordParts(std::size_t begin, std::size_t end) {
    double largest = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t first = first_[i], last = first_[i + 1];
      Vec3 mean = Vec3::Zero();
      for (std::size_t k = first; k < last; ++k) {
        mean += own_[k];
        const double far = own_[k].norm() + radii_[k];
        largest = std::max(largest, far * far);
      }
      mean /= static_cast<double>(last - first);
      Mat3 second = Mat3::Zero();
      for (std::size_t k = first; k < last; ++k)
        second += (own_[k] - mean) * (own_[k] - mean).transpose();
      second /= static_cast<double>(last - first);
      using Column = PrimitiveReferences::Column;
      for (int c = 0; c < 3; ++c) records.column(Column::kX + c)[i] = static_cast<float>(mean[c]);
      records.column(Column::kWeight)[i] = 1;
      int column = Column::kXX;
      for (int k = 0; k < 3; ++k)
        for (int l = k; l < 3; ++l) records.column(column++)[i] = static_cast<float>(second(k, l));
      records.column(Column::kTriangle)[i] = std::bit_cast<float>(static_cast<std::uint32_t>(i));
    }
    return largest;
  }

  /// Fills all records, and sets the radius. `fill(begin, end)` fills some records, and returns the
  /// largest square of the distance of one of their points from the origin.
  template <class Fill>
  void record(unsigned threads, const Fill& fill) {
    double square = 0;
    std::mutex mutex;
    inParts(threads, size(), [&](std::size_t begin, std::size_t end) {
      const double own = fill(begin, end);
      const std::lock_guard lock(mutex);
      square = std::max(square, own);
    });
    radius = roundedUp(std::sqrt(square) / scale);
  }

  const TriangleMesh* mesh_ = nullptr;
  std::span<const ConvexPart> parts_;
  std::vector<Vec3> own_;      // vertices, or centres of balls, in the tree's frame and unit
  std::vector<double> radii_;  // of the balls, in the tree's unit
  // The first ball of each part. The last entry is the number of balls.
  std::vector<std::size_t> first_;
};

}  // namespace corridor::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
