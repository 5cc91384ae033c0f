#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "collision/core/transform.h"

namespace corridor {

/// Points in columns of coordinates, for SIMD kernels that visit all of them: for some hundred
/// points, this is quicker than climbing along the edges of their hull. The kernels round every
/// product and every sum once, so results are the same on every instruction set.
class PointColumns {
 public:
  /// @pre there is at least one point and at most 2^28, and all coordinates are finite.
  explicit PointColumns(std::vector<Vec3> points);

  std::span<const Vec3> points() const { return points_; }
  /// The mean of the points, rounded.
  const Vec3& center() const { return center_; }
  /// The largest squared distance of a point from the origin, rounded.
  double reachSquared() const { return reachSquared_; }

  /// Returns the index of the point whose rounded product with m is the largest; the first of equal
  /// ones. @pre m is finite.
  std::uint32_t farthest(const Vec3& m) const;
  /// Returns the smallest m·p − |v·p + shift| over all points p, rounded; NaN if an argument is not
  /// finite. This is the smallest m·p + s·(v·p + shift) over |s| ≤ 1.
  double leastAround(const Vec3& m, const Vec3& v, double shift) const;

 private:
  std::vector<Vec3> points_;
  std::vector<double> columns_;  // x, y, z: each `stride_` long, filled up with the last point
  std::size_t stride_ = 0;
  Vec3 center_ = Vec3::Zero();
  double reachSquared_ = 0;
};

}  // namespace corridor
