#include "collision/volumes/shell.h"

#include <algorithm>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "collision/convex/simplex.h"
#include "collision/core/rounding.h"
#include "collision/volumes/bounding_sphere.h"
#include "collision/volumes/principal_axes.h"

namespace corridor {
namespace {

/// The largest distance of a shell's centre from its content, relative to the size of the content.
/// A flat content of radius ρ then has a shell of thickness ρ/512. A larger distance would cost
/// digits, because margins grow with the outer radius.
constexpr double kFarthest = 256;
/// Cones with a larger slope than this are dropped.
constexpr double kWidest = 64;

/// The sums from which the fits are computed. Points q are relative to the box's centre, in the
/// unit of length of `Shell::around`.
struct Sums {
  Eigen::Matrix4d squares = Eigen::Matrix4d::Zero();  // of (q, 1)
  Eigen::Vector4d cubes = Eigen::Vector4d::Zero();    // |q|²(q, 1)

  void add(const Vec3& q) {
    const Eigen::Vector4d row(q[0], q[1], q[2], 1);
    squares += row * row.transpose();
    cubes += q.squaredNorm() * row;
  }
  /// Returns the centre c of the sphere for which Σ(|q − c|² − r²)² is least: |q|² = 2c·q + k is
  /// linear in c and k.
  Vec3 sphereCenter() const {
    Eigen::Matrix4d regular = squares;
    regular.diagonal() *= 1 + 0x1p-36;
    return 0.5 * regular.ldlt().solve(cubes).head<3>();
  }
  Vec3 shortestExtent() const {
    const double count = squares(3, 3);
    const Vec3 mean = squares.block<3, 1>(0, 3) / count;
    return principalAxes(squares.block<3, 3>(0, 0) / count - mean * mean.transpose()).col(2);
  }
};

double solidAngleShare(const Shell& shell) {
  return shell.hasCone() ? 1 - shell.cosine() : 2;
}
double volumeOf(const Shell& shell, double unit) {
  const double out = (shell.outer + shell.size) / unit,
               in = std::max(0.0, shell.inner - shell.size) / unit;
  return (out - in) * (out * out + out * in + in * in) * solidAngleShare(shell);
}

/// Returns the shell about this centre, with a cone towards `towards` if all points allow one.
///
/// All lengths are computed in this `unit`, from d = p − center, which is off by u|d|. Dot and
/// cross products with the axis, of length 1 up to 2u, are off by less than 8u|d|, and so are
/// projections on another direction. 32u|d| covers them and the norms. Underflow takes less than
/// kTiny metres from a difference, and less than 2^-510 units from the squares of a norm; `tiny`
/// covers both.
Shell shellAbout(const Vec3& center, const Vec3& towards, const Content& content, double unit) {
  Shell shell;
  shell.center = center;
  const auto local = [&](const Vec3& p) -> Vec3 { return (p - center) / unit; };
  const double tiny = kTiny / unit + 0x1p-500;
  double outer = center.allFinite() ? 0 : HUGE_VAL;  // a NaN distance would be dropped below
  content.forEach([&](const Vec3& p, double r) {
    outer = std::max(outer, local(p).norm());
    shell.size = std::max(shell.size, r);
  });
  const double pad = roundedUp(32 * kUnit * outer + tiny);

  const Vec3 axis = (towards - center) / unit;
  if (axis.norm() > 0x1p-20) {
    shell.axis = axis.normalized();
    shell.slope = 0;
    content.forEach([&](const Vec3& p, double) {
      const Vec3 d = local(p);
      const double noise = 32 * kUnit * d.norm() + tiny, along = shell.axis.dot(d) - noise;
      const double slope = along > 0 ? (d.cross(shell.axis).norm() + noise) / along : HUGE_VAL;
      shell.slope = std::max(shell.slope, roundedUp(slope));
    });
    if (!(shell.slope < kWidest)) shell.slope = Shell::kNoCone;
  }

  double inner = HUGE_VAL;
  for (const Triangle& t : content.triangles) {
    const Vec3 p = local(t[0]), q = local(t[1]), r = local(t[2]), n = towardsTriangle(p, q, r);
    const double length = n.norm();
    const double least = std::min({n.dot(p), n.dot(q), n.dot(r)}) / length;
    inner = std::min(inner, least > 0 ? least : 0);  // NaN: 0
  }
  if (!content.balls.empty() && !shell.hasCone()) inner = 0;
  for (const Ball& b : content.balls) inner = std::min(inner, shell.axis.dot(local(b.center)));
  shell.inner = std::max(0.0, unit * roundedDown(inner - pad));
  shell.outer = roundedUp(unit * (outer + pad));

  // The bounding sphere is about a point of the axis, at the distance m from the centre, and
  // contains the rims of both spheres. All other points of the core are nearer to the centre of
  // this sphere: the squared distance of a point d is |d|² + m² − 2m·|d|·cos α for its angle α with
  // the axis. This is convex in |d|, and grows with the angle. The centre of the sphere is off by
  // 4u of its terms.
  double m = 0;
  shell.boundingRadius = shell.outer;
  shell.boundingCenter = shell.center;
  if (shell.hasCone()) {
    const double cosine = shell.cosine(), sine = shell.slope * cosine, out = shell.outer / unit,
                 in = shell.inner / unit;
    m = std::min(out * cosine, 0.5 * (out + in) / cosine);
    shell.boundingCenter = shell.center + unit * m * shell.axis;
    const auto rim = [&](double r) { return Vec3(r * sine, r * cosine - m, 0).norm(); };
    shell.boundingRadius = unit * (std::max(rim(out), rim(in)) + 32 * kUnit * out) +
                           4 * kUnit * shell.boundingCenter.cwiseAbs().sum();
  }
  shell.boundingRadius = roundedUp(shell.boundingRadius + shell.size);
  return shell;
}

}  // namespace

Vec3 towardsTriangle(const Vec3& p, const Vec3& q, const Vec3& r) {
  using Point = gjk::Vector<double>;
  const gjk::Nearest<double> found = gjk::nearest(Point(p), Point(q), Point(r));
  const Vec3 n(found.v.x, found.v.y, found.v.z);
  return n / n.cwiseAbs().maxCoeff();
}

Shell Shell::around(const Obb& box, const Content& content) {
  // The unit of length is a power of two near the size, so that squares neither overflow nor
  // underflow. Scaling by this unit is exact.
  const double size = box.half.maxCoeff(), unit = powerOfTwo(size);
  Sums sums;
  content.forEach([&](const Vec3& p, double) { sums.add((p - box.center) / unit); });
  const Vec3 flat = kFarthest * sums.shortestExtent();
  Vec3 best = sums.sphereCenter();
  if (best.norm() > kFarthest) best *= kFarthest / best.norm();

  const Vec3 middle = BoundingSphere::around(box, content).center;
  Shell least = shellAbout(middle, middle, content, unit);
  if (!(size > 0x1p-900)) return least;  // the content is too small for the fits below
  for (const Vec3& v : {best, flat, Vec3(-flat)}) {
    if (!v.allFinite()) continue;
    const Shell other = shellAbout(box.center + unit * v, box.center, content, unit);
    if (other.outer < HUGE_VAL && volumeOf(other, unit) < volumeOf(least, unit)) least = other;
  }
  return least;
}

double Shell::centerReach() const {
  return roundedUp(std::max(center.stableNorm(), boundingCenter.stableNorm()));
}

}  // namespace corridor
