#include "planner/view/volume_outline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace corridor::view {
namespace {

std::vector<Vec3> corners(const Vec3& center, const Mat3& axes, const Vec3& half) {
  std::vector<Vec3> points;
  for (int i = 0; i < 8; ++i) {
    const Vec3 sign(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    points.emplace_back(center + axes * sign.cwiseProduct(half));
  }
  return points;
}

/// Returns unit vectors at an angle of at most `angle` from the z axis: the axis itself, and rings
/// around it.
std::vector<Vec3> directions(double angle) {
  constexpr int kRings = 8, kAround = 16;
  std::vector<Vec3> all = {Vec3::UnitZ()};
  for (int ring = 1; ring <= kRings; ++ring)
    for (int i = 0; i < kAround; ++i) {
      const double u = angle * ring / kRings, v = 2 * std::numbers::pi * i / kAround;
      all.emplace_back(std::sin(u) * std::cos(v), std::sin(u) * std::sin(v), std::cos(u));
    }
  return all;
}

}  // namespace

ConvexPart outline(const Obb& box) {
  return {corners(box.center, box.axes, box.half)};
}

ConvexPart outline(const Aabb& box) {
  return {corners(box.center, Mat3::Identity(), box.half)};
}

ConvexPart outline(const BoundingSphere& sphere) {
  return {{sphere.center}, sphere.size};
}

ConvexPart outline(const Rss& rss) {
  return {corners(rss.core.center, rss.core.axes, rss.core.half), rss.size};
}

/// Returns the corners of a k-DOP: the points where three faces' planes meet, except points outside
/// of another slab.
template <int K>
ConvexPart outline(const Kdop<K>& kdop) {
  constexpr std::size_t slabs = K / 2;
  const auto& normals = slabDirections<K>();
  double size = 0;
  for (std::size_t i = 0; i < slabs; ++i)
    size = std::max({size, std::abs(kdop.low[i]), std::abs(kdop.high[i])});
  std::vector<Vec3> points;
  const auto addCorner = [&](const std::array<std::size_t, 3>& at, int sides) {
    Mat3 m;
    Vec3 offsets;
    for (int r = 0; r < 3; ++r) {
      m.row(r) = normals[at[r]].transpose();
      offsets[r] = (sides >> r & 1 ? kdop.high : kdop.low)[at[r]];
    }
    if (std::abs(m.determinant()) < 0.5) return;  // the determinant is a whole number
    const Vec3 p = m.inverse() * offsets;
    for (std::size_t i = 0; i < slabs; ++i)
      if (const double x = normals[i].dot(p);
          x < kdop.low[i] - 1e-9 * size || x > kdop.high[i] + 1e-9 * size)
        return;
    for (const Vec3& q : points)
      // This corner was found before, from three other faces.
      if ((p - q).norm() < 1e-7 * size) return;
    points.push_back(p);
  };
  for (std::size_t i = 0; i < slabs; ++i)
    for (std::size_t j = i + 1; j < slabs; ++j)
      for (std::size_t k = j + 1; k < slabs; ++k)
        for (int sides = 0; sides < 8; ++sides) addCorner({i, j, k}, sides);
  return {points};
}
ConvexPart outline(const Ellipsoid& ellipsoid) {
  std::vector<Vec3> points;
  for (const Vec3& n : directions(std::numbers::pi))
    points.emplace_back(ellipsoid.core.center +
                        ellipsoid.core.axes * ellipsoid.core.half.cwiseProduct(n));
  return {points, ellipsoid.size};
}

ConvexPart outline(const Hull& hull) {
  return {hull.vertices, hull.size};
}

ConvexPart outline(const Shell& shell) {
  Mat3 toAxis;  // a rotation that takes the z axis to the shell's axis
  toAxis.col(0) = shell.axis.unitOrthogonal();
  toAxis.col(1) = shell.axis.cross(toAxis.col(0));
  toAxis.col(2) = shell.axis;
  std::vector<Vec3> points;
  for (const Vec3& n : directions(shell.hasCone() ? std::atan(shell.slope) : std::numbers::pi))
    for (const double radius : {shell.inner, shell.outer})
      points.emplace_back(shell.center + radius * (toAxis * n));
  return {points, shell.size};
}

template ConvexPart outline(const Kdop<14>&);
template ConvexPart outline(const Kdop<18>&);
template ConvexPart outline(const Kdop<26>&);

}  // namespace corridor::view
