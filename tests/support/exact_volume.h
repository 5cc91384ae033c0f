#pragma once

#include <algorithm>
#include <array>
#include <string>

#include <boost/multiprecision/cpp_int.hpp>

#include "collision/volumes/aabb.h"
#include "collision/volumes/bounding_sphere.h"
#include "collision/volumes/kdop.h"
#include "collision/volumes/obb.h"
#include "collision/volumes/rss.h"

/// Volumes as sets with rational coordinates. `treeFault` proves containment with them.
namespace corridor::exact {

using Rational = boost::multiprecision::cpp_rational;

/// Returns `what` and the number i, for example "node 3". The function is for the messages of
/// `treeFault`.
inline std::string named(const char* what, std::size_t i) {
  return std::string(what) + " " + std::to_string(i);
}
using Row = std::array<Rational, 3>;

inline Row row(const Vec3& p) {
  return {Rational(p[0]), Rational(p[1]), Rational(p[2])};
}
inline Rational dot(const Row& a, const Row& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Row cross(const Row& a, const Row& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline Row minus(const Row& a, const Row& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

/// Each specialisation has `contains(p, r)`. It returns true if the solid sphere of radius r about
/// p is proved to be in a convex subset of the volume. This subset is the same for all spheres, so
/// the hull of several such spheres is inside, too. The specialisation for a volume that isn't
/// convex also has `containsTriangle`.
template <class Volume>
class ExactVolume;

/// The box {c + U x : |x_i| ≤ e_i} with the centre c, the axes as the columns of U, and the half
/// extents e_i. By Cramer's rule p is inside if and only if |det(U with column i replaced by p −
/// c)| ≤ e_i·|det U| for every i.
template <>
class ExactVolume<Obb> {
 public:
  explicit ExactVolume(const Obb& box) : center_(row(box.center)), half_(row(box.half)) {
    for (int k = 0; k < 3; ++k) u_[k] = row(box.axes.col(k));
    for (int k = 0; k < 3; ++k) crosses_[k] = cross(u_[(k + 1) % 3], u_[(k + 2) % 3]);
    volume_ = abs(dot(u_[0], crosses_[0]));
  }
  bool contains(const Row& p, const Rational& radius) const { return contains(p, radius, {}); }
  /// Returns whether the box contains the disc of this radius about p that is orthogonal to `axis`.
  /// If `axis` is zero, returns whether the box contains the sphere of this radius about p.
  ///
  /// Let d be the axis, and g_i = crosses_i/volume, which is row i of U⁻¹. Along coordinate i of
  /// the box a sphere extends r|g_i| from its centre, and a disc r|g_i × d|/|d|. The conditions are
  /// squared, so that both sides are rational.
  bool contains(const Row& p, const Rational& radius, const Row& axis) const {
    const Row d = minus(p, center_);
    for (int k = 0; k < 3; ++k) {
      const Rational left = half_[k] * volume_ - abs(dot(d, crosses_[k]));
      if (left < 0) return false;
      if (radius == 0) continue;
      const Rational square = dot(axis, axis), r = radius * radius;
      const Row across = cross(crosses_[k], axis);
      const bool holds = square > 0 ? left * left * square >= r * dot(across, across)
                                    : left * left >= r * dot(crosses_[k], crosses_[k]);
      if (!holds) return false;
    }
    return volume_ > 0;
  }
  /// Returns the eight corners. A convex set that contains them contains the box.
  std::array<Row, 8> corners() const {
    std::array<Row, 8> all;
    for (int i = 0; i < 8; ++i) {
      all[i] = center_;
      for (int k = 0; k < 3; ++k)
        for (int c = 0; c < 3; ++c) all[i][c] += (i >> k & 1 ? 1 : -1) * half_[k] * u_[k][c];
    }
    return all;
  }

 private:
  Row center_, half_;
  std::array<Row, 3> u_, crosses_;
  Rational volume_;
};

template <>
class ExactVolume<Aabb> {
 public:
  explicit ExactVolume(const Aabb& box) : center_(row(box.center)), half_(row(box.half)) {}
  bool contains(const Row& p, const Rational& radius) const {
    for (int i = 0; i < 3; ++i)
      if (abs(p[i] - center_[i]) + radius > half_[i]) return false;
    return true;
  }

 private:
  Row center_, half_;
};

template <>
class ExactVolume<BoundingSphere> {
 public:
  explicit ExactVolume(const BoundingSphere& sphere)
      : center_(row(sphere.center)), radius_(sphere.size) {}
  bool contains(const Row& p, const Rational& radius) const {
    const Row d = minus(p, center_);
    const Rational left = radius_ - radius;
    return left >= 0 && dot(d, d) <= left * left;
  }

 private:
  Row center_;
  Rational radius_;
};

/// Tests each slab, with its direction n, which need not have unit length. A sphere extends r|n|
/// from its centre along n. The test compares squares, which are rational.
template <int K>
class ExactVolume<Kdop<K>> {
 public:
  explicit ExactVolume(const Kdop<K>& dop) {
    for (std::size_t i = 0; i < low_.size(); ++i) low_[i] = dop.low[i], high_[i] = dop.high[i];
  }
  bool contains(const Row& p, const Rational& radius) const {
    const auto& n = slabDirections<K>();
    for (std::size_t i = 0; i < n.size(); ++i) {
      Rational along = 0;
      for (int c = 0; c < 3; ++c)
        if (n[i][c] != 0) along += n[i][c] > 0 ? p[c] : -p[c];
      if (along < low_[i] || along > high_[i]) return false;
      if (radius == 0) continue;
      const Rational left = std::min<Rational>(along - low_[i], high_[i] - along);
      if (left * left < radius * radius * Rational(n[i].squaredNorm())) return false;
    }
    return true;
  }

 private:
  std::array<Rational, K / 2> low_, high_;
};

/// Proves containment by a witness: a point of the rectangle that is near enough to p. The only
/// candidate is the closest point as computed in double, so the proof may fail for a sphere that is
/// inside.
template <>
class ExactVolume<Rss> {
 public:
  explicit ExactVolume(const Rss& rss) : rss_(rss), center_(row(rss.core.center)) {
    for (int k = 0; k < 2; ++k) u_[k] = row(rss.core.axes.col(k));
  }
  bool contains(const Row& p, const Rational& radius) const {
    Row d = minus(p, center_);
    const Vec3 offset(d[0].convert_to<double>(), d[1].convert_to<double>(),
                      d[2].convert_to<double>());
    for (int k = 0; k < 2; ++k) {
      const double half = rss_.core.half[k];
      const Rational x(std::clamp(rss_.core.axes.col(k).dot(offset), -half, half));
      for (int c = 0; c < 3; ++c) d[c] -= x * u_[k][c];
    }
    const Rational left = Rational(rss_.size) - radius;
    return left >= 0 && dot(d, d) <= left * left;
  }

 private:
  Rss rss_;
  Row center_;
  std::array<Row, 2> u_;
};

}  // namespace corridor::exact
