#include "collision/volumes/part_obb.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "collision/core/rounding.h"

namespace corridor {
namespace {

/// Returns orthonormal axes: the first along u, the second in the plane of u and v. If v is
/// parallel to u, the second axis is any vector orthogonal to u. If u vanishes, returns the
/// identity.
Mat3 axesAlong(const Vec3& u, const Vec3& v) {
  const Vec3 x = u.stableNormalized();
  if (!(std::abs(x.norm() - 1) < 0x1p-20)) return Mat3::Identity();
  Vec3 y = v.stableNormalized();
  y -= x * x.dot(y);
  if (!(y.norm() > 0x1p-20)) y = x.unitOrthogonal();
  y = (y - x * x.dot(y)).normalized();
  y = (y - x * x.dot(y)).normalized();
  Mat3 axes;
  axes << x, y, x.cross(y);
  return axes.allFinite() && orthonormalityDefect(axes) < 0x1p-40 ? axes : Mat3::Identity();
}

/// Returns the box with the smaller sum of half extents. (The volume of flat boxes is 0, so volumes
/// cannot be compared.)
const Obb& smaller(const Obb& a, const Obb& b) {
  return a.half.sum() <= b.half.sum() ? a : b;
}

/// Reports whether all points are corners of the box, up to rounding. If so, no box is smaller.
bool isCornersOf(const Obb& box, const std::vector<Vec3>& points) {
  return std::all_of(points.begin(), points.end(), [&](const Vec3& p) {
    const Vec3 x = (box.axes.transpose() * (p - box.center)).cwiseAbs();
    return (x.array() >= (1 - 0x1p-20) * box.half.array()).all();
  });
}

}  // namespace

Obb enclosingObb(const ConvexPart& part) {
  const auto& points = part.points;
  std::vector<Ball> corners;
  for (const Vec3& p : points) corners.push_back({p});
  const auto edge = [&](std::size_t i) {
    return i < points.size() ? Vec3(points[i] - points[0]) : Vec3::Zero();
  };
  Obb box = enclosingObb(corners, axesAlong(edge(1), edge(2)));
  if (points.size() > 2 && !isCornersOf(box, points))
    box = smaller(box, enclosingObb(corners, fitFrame(corners, ObbFit::hull).axes));
  if (part.radius == 0) return box;

  // A sphere of radius r reaches r|g_i| along axis i, where g_i are the rows of U⁻¹. A disc
  // orthogonal to d̂ reaches r|g_i × d̂|. With η the defect of the axes, |g_i − u_i| ≤ 4η, because
  // U⁻¹ = (UᵀU)⁻¹Uᵀ and |UᵀU − I|₂ ≤ 3η. Also, |u_i| ≤ 1 + η. Rounding of d̂ and of the cross
  // product takes less than 16u.
  const double loose = 6 * orthonormalityDefect(box.axes) + 16 * kUnit;
  const Vec3 d = edge(1).stableNormalized();
  const bool discs = part.flatEnds && std::abs(d.norm() - 1) < 0x1p-20;
  for (int i = 0; i < 3; ++i) {
    const double share = discs ? box.axes.col(i).cross(d).norm() : 1;
    box.half[i] = roundedUp(box.half[i] + part.radius * (share + loose));
  }
  return box;
}

std::vector<Ball> ballsOf(const ConvexPart& part) {
  std::vector<Ball> balls;
  addBallsOf(part, balls);
  return balls;
}

void addBallsOf(const ConvexPart& part, std::vector<Ball>& balls) {
  if (!part.flatEnds) {
    for (const Vec3& p : part.points) balls.push_back({p, part.radius});
    return;
  }
  const Obb box = enclosingObb(part);
  // Each coordinate of a corner c ± Σ half_k u_k takes 6 roundings of numbers below |c|₁ + 2·Σhalf.
  const double error = roundedUp(16 * kUnit * (box.center.cwiseAbs().sum() + 2 * box.half.sum()));
  for (int i = 0; i < 8; ++i) {
    const Vec3 x(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    balls.push_back({box.center + box.axes * x.cwiseProduct(box.half), error});
  }
}

}  // namespace corridor
