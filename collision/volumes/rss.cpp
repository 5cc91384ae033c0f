#include "collision/volumes/rss.h"

#include <algorithm>
#include <cmath>

#include "collision/core/rounding.h"

namespace corridor {
namespace {

/// The interval [low, high] of the rectangle along one of its axes.
struct Side {
  double low = HUGE_VAL, high = -HUGE_VAL;
  void settle() {  // low > high if the sphere alone covers the content: one point suffices
    if (low > high) low = high = low + 0.5 * (high - low);
  }
};

/// For a point that lies beyond a corner of the rectangle by (dx, dy): returns how far the corner
/// must move out, by the same length along both axes, so that the corner is within √square of the
/// point.
double push(double dx, double dy, double square) {
  const double apart = 0.5 * (dx - dy);
  return 0.5 * (dx + dy) - std::sqrt(std::max(0.0, 0.5 * square - apart * apart));
}

}  // namespace

Rss Rss::around(const Obb& box, const Content& content) {
  Rss rss;
  // The rectangle's normal is the box's shortest axis.
  int normal = 0;
  box.half.minCoeff(&normal);
  for (int i = 0; i < 3; ++i) rss.core.axes.col(i) = box.axes.col((normal + 1 + i) % 3);
  if (!(box.half.maxCoeff() < HUGE_VAL)) {  // an overflow
    rss.core.center = box.center;
    rss.core.half.fill(HUGE_VAL);
    return rss;
  }
  // Coordinates are relative to the box's centre, in a unit that is a power of two near its size.
  // Scaling by this unit is exact, and no square overflows.
  const double unit = powerOfTwo(box.half.maxCoeff());
  const auto local = [&](const Vec3& p, const Vec3& center) -> Vec3 {
    return rss.core.axes.transpose() * ((p - center) / unit);
  };
  const double radius = box.half[normal] / unit;

  // First the rectangle gets the interval that it needs along each axis, regardless of the other
  // axis. Then the corners move out where necessary.
  Side x, y;
  // For a sphere of the content, of radius r and with its centre at height z above the rectangle's
  // plane: returns the square of the largest distance, measured in this plane, from that centre to
  // a point of the rectangle about which the RSS's own sphere covers the content's sphere.
  const auto squareAt = [&](double z, double r) {
    const double left = std::max(0.0, radius - r);
    return std::max(0.0, left * left - z * z);
  };
  content.forEach([&](const Vec3& p, double r) {
    const Vec3 q = local(p, box.center);
    const double reach = std::sqrt(squareAt(q[2], r / unit));
    x.low = std::min(x.low, q[0] + reach), x.high = std::max(x.high, q[0] - reach);
    y.low = std::min(y.low, q[1] + reach), y.high = std::max(y.high, q[1] - reach);
  });
  x.settle(), y.settle();
  content.forEach([&](const Vec3& p, double r) {
    const Vec3 q = local(p, box.center);
    const double dx = std::max(q[0] - x.high, x.low - q[0]),
                 dy = std::max(q[1] - y.high, y.low - q[1]);
    const double square = squareAt(q[2], r / unit);
    if (!(dx > 0 && dy > 0 && dx * dx + dy * dy > square)) return;
    const double out = std::max(0.0, push(dx, dy, square));
    (q[0] > x.high ? x.high : x.low) += q[0] > x.high ? out : -out;
    (q[1] > y.high ? y.high : y.low) += q[1] > y.high ? out : -out;
  });
  const Vec3 middle(0.5 * (x.low + x.high), 0.5 * (y.low + y.high), 0);
  rss.core.center = box.center + unit * (rss.core.axes * middle);
  const Vec3 half(std::max(0.0, x.high - middle[0]), std::max(0.0, y.high - middle[1]), 0);
  rss.core.half = unit * half;

  // This radius makes the volume contain its content, for any rectangle. Let U be the axes and η
  // their defect. In coordinates x = U⁻¹(p − centre), a point differs from its computed y by at
  // most 2(η + 6u)·Σ|y_k| per coordinate (`enclosingObb`). U stretches by at most 1 + 1.5η.
  double farthest = 0;
  Vec3 reach = Vec3::Zero();
  content.forEach([&](const Vec3& p, double r) {
    const Vec3 q = local(p, rss.core.center).cwiseAbs();
    reach = reach.cwiseMax(q);
    farthest = std::max(farthest, (q - half).cwiseMax(0).norm() + r / unit);
  });
  const double defect = orthonormalityDefect(rss.core.axes);
  const double pad = 2 * (defect + 6 * kUnit) * reach.sum();
  rss.size = roundedUp(unit * ((farthest + 2 * pad) * (1 + 2 * defect)));
  return rss;
}

double Rss::radius() const {
  return roundedUp(core.radius() + size);
}

}  // namespace corridor
