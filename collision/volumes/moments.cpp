#include "collision/volumes/moments.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "collision/core/rounding.h"
#include "collision/volumes/obb.h"

namespace corridor {
namespace {

/// Coordinates about a local origin and in a power-of-two unit near their size: offsets of 10^6
/// don't cancel, and squares neither over- nor underflow. Both are exact to undo.
struct LocalUnit {
  Vec3 origin;
  double unit = 1;

  explicit LocalUnit(std::span<const Triangle> triangles) {
    Vec3 low = triangles[0][0], high = low;
    for (const Triangle& t : triangles)
      for (const Vec3& p : t) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
      }
    origin = low + 0.5 * (high - low);
    const double size = (high - low).maxCoeff();
    if (size > 0 && std::isfinite(size)) unit = powerOfTwo(size);
  }
  Vec3 operator()(const Vec3& p) const { return (p - origin) / unit; }
  Moments global(Moments local) const {
    local.mean =
        origin + unit * local.mean;  // the covariance keeps the local unit: only its axes are used
    return local;
  }
};

}  // namespace

Moments vertexMoments(std::span<const Triangle> triangles) {
  const LocalUnit local(triangles);
  Moments m;
  Mat3 second = Mat3::Zero();
  for (const Triangle& t : triangles)
    for (const Vec3& corner : t) {
      const Vec3 p = local(corner);
      m.mean += p;
      second += p * p.transpose();
    }
  m.weight = 3.0 * static_cast<double>(triangles.size());
  m.mean /= m.weight;
  m.covariance = second / m.weight - m.mean * m.mean.transpose();
  return local.global(m);
}

Moments surfaceMoments(std::span<const Triangle> triangles) {
  const LocalUnit local(triangles);
  Moments m;
  Mat3 second = Mat3::Zero();
  for (const Triangle& t : triangles) {
    const Vec3 p = local(t[0]), q = local(t[1]), r = local(t[2]);
    const double area = 0.5 * (q - p).cross(r - p).norm();
    const Vec3 c = (p + q + r) / 3;
    m.weight += area;
    m.mean += area * c;
    second += area / 12 *
              (9 * c * c.transpose() + p * p.transpose() + q * q.transpose() + r * r.transpose());
  }
  if (!(m.weight > 0)) return {};
  m.mean /= m.weight;
  m.covariance = second / m.weight - m.mean * m.mean.transpose();
  return local.global(m);
}

/// Eberly, A Robust Eigensolver for 3x3 Symmetric Matrices, 2014: the eigenvalue that is farther
/// from the middle one by a cosine, its vector by the largest cross product of two rows, the others
/// in the plane orthogonal to it.
Mat3 principalAxes(const Mat3& covariance) {
  const double trace = covariance.trace();
  if (!(trace > 0) || !std::isfinite(1 / trace)) return Mat3::Identity();
  const Mat3 b = covariance / trace - Mat3::Identity() / 3;
  const double p = std::sqrt(b.squaredNorm() / 6);
  const double half = b.determinant() / (2 * p * p * p);
  const bool largest = half >= 0;
  const double angle = std::acos(std::clamp(half, -1.0, 1.0)) / 3;
  const Mat3 rest =
      b - 2 * p * std::cos(largest ? angle : angle + 2 * std::numbers::pi / 3) * Mat3::Identity();
  const Vec3 rows[3] = {rest.row(0), rest.row(1), rest.row(2)};
  Vec3 w = rows[0].cross(rows[1]);
  for (const Vec3& other : {Vec3(rows[1].cross(rows[2])), Vec3(rows[2].cross(rows[0]))})
    if (other.squaredNorm() > w.squaredNorm()) w = other;
  if (!(w.squaredNorm() > 0x1p-160)) return Mat3::Identity();  // a ball's
  w *= 1 / std::sqrt(w.squaredNorm());
  // A basis of the plane, of the coordinate axis that is farthest from w.
  int k = 0;
  w.cwiseAbs().minCoeff(&k);
  Vec3 s = w.cross(Vec3::Unit(k));
  s *= 1 / std::sqrt(s.squaredNorm());
  const Vec3 t = w.cross(s), bs = b * s;
  const double x = 0.5 * (bs.dot(s) - t.dot(b * t)), h = bs.dot(t), r = std::sqrt(x * x + h * h);
  Eigen::Vector2d turn = x >= 0 ? Eigen::Vector2d(x + r, h) : Eigen::Vector2d(h, r - x);
  const double length = std::sqrt(turn.squaredNorm());
  turn = length > 0x1p-80 ? Eigen::Vector2d(turn / length) : Eigen::Vector2d(1, 0);
  const Vec3 u = turn[0] * s + turn[1] * t, v = w.cross(u);  // the plane's larger and smaller
  Mat3 axes;
  if (largest) {
    axes << w, u, v;
  } else {
    axes << u, v, w;  // w × u = v, so that u × v = w
  }
  return orthonormalityDefect(axes) < 0x1p-40 ? axes : Mat3::Identity();  // or NaN
}

}  // namespace corridor
