#include "collision/volumes/ellipsoid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "collision/core/rounding.h"

namespace corridor {
namespace {

// More steps would reduce the volume of the ellipsoid by less than 1 %.
constexpr int kFitSteps = 24;

/// Keeps the points that are extreme along 13 lines. These points decide most of the ellipsoid's
/// shape. The ellipsoid's scale is found from all points.
class ExtremePoints {
 public:
  void add(const Vec3& z) {
    const double along[kLines] = {z[0],
                                  z[1],
                                  z[2],
                                  z[0] + z[1],
                                  z[0] - z[1],
                                  z[1] + z[2],
                                  z[1] - z[2],
                                  z[2] + z[0],
                                  z[2] - z[0],
                                  z.sum(),
                                  z[0] + z[1] - z[2],
                                  z[0] - z[1] + z[2],
                                  z[0] - z[1] - z[2]};
    for (std::size_t i = 0; i < kLines; ++i) {
      if (along[i] < low_[i].along) low_[i] = {along[i], z};
      if (along[i] > high_[i].along) high_[i] = {along[i], z};
    }
  }
  std::vector<Vec3> points() const {
    std::vector<Vec3> all;
    const auto keep = [&](const Vec3& z) {
      if (std::find(all.begin(), all.end(), z) == all.end()) all.push_back(z);
    };
    for (const Extreme& e : low_) keep(e.z);
    for (const Extreme& e : high_) keep(e.z);
    return all;
  }

 private:
  static constexpr std::size_t kLines = 13;
  struct Extreme {
    double along;
    Vec3 z = Vec3::Zero();
  };
  static std::array<Extreme, kLines> filled(double value) {
    std::array<Extreme, kLines> all;
    for (Extreme& e : all) e.along = value;
    return all;
  }
  std::array<Extreme, kLines> low_ = filled(HUGE_VAL), high_ = filled(-HUGE_VAL);
};

struct Shape {
  Vec3 center, semiAxes;
};

/// Returns the shape of nearly the smallest ellipsoid around the points, with axes parallel to the
/// coordinate axes.
/// @param z  points whose extent along each axis is about [−1, 1].
Shape smallest(const std::vector<Vec3>& z) {
  std::vector<double> weight(z.size(), 1 / static_cast<double>(z.size()));
  Vec3 mean, variance;
  for (int step = 0;; ++step) {
    mean.setZero(), variance.setZero();
    for (std::size_t i = 0; i < z.size(); ++i) mean += weight[i] * z[i];
    for (std::size_t i = 0; i < z.size(); ++i) variance += weight[i] * (z[i] - mean).cwiseAbs2();
    if (step == kFitSteps) break;
    // Along some axis all points may be equal up to rounding. The lower limit keeps such an axis
    // from changing the weights.
    const Vec3 used = variance.cwiseMax(0x1p-20);
    double sum = 0, most = 0;
    for (std::size_t i = 0; i < z.size(); ++i) {
      const double out = 1 + (z[i] - mean).cwiseAbs2().cwiseQuotient(used).sum();
      weight[i] *= out;
      sum += weight[i];
      most = std::max(most, out);
    }
    for (double& w : weight) w /= sum;
    if (most <= 1.01 * sum) break;
  }
  // The points extend over [−1, 1], so a semi-axis is at least 1, except along an axis on which the
  // extent is rounding error.
  return {mean, (3 * variance).cwiseMax(1).cwiseSqrt()};
}

}  // namespace

Ellipsoid Ellipsoid::around(const Obb& box, const Content& content) {
  Ellipsoid e;
  e.core.axes = box.axes;
  // Coordinates are relative to a centre, in a unit that is a power of two near the size. Scaling
  // by this unit is exact, and no square overflows.
  const double unit = powerOfTwo(box.half.maxCoeff());
  const Vec3 scale = box.half / unit;
  const auto local = [&](const Vec3& p, const Vec3& center) -> Vec3 {
    return box.axes.transpose() * ((p - center) / unit);
  };
  ExtremePoints extreme;
  content.forEach([&](const Vec3& p, double r) {
    extreme.add(local(p, box.center).cwiseQuotient(scale));
    e.size = std::max(e.size, r);
  });
  const Shape shape = smallest(extreme.points());
  e.core.center = box.center + unit * (box.axes * shape.center.cwiseProduct(scale));
  const Vec3 semiAxes = shape.semiAxes.cwiseProduct(scale);

  // This factor makes the ellipsoid contain its content, for any centre and semi-axes. Let U be the
  // axes of the box and η their defect. In coordinates x = U⁻¹(p − centre), a point differs from
  // its computed y by at most pad = 2(η + 6u)·Σ|y_k| per coordinate (`enclosingObb`); kTiny covers
  // underflow. If Σ((|y_i| + pad)/semiAxis_i)² ≤ s², then the ellipsoid of the semi-axes
  // s·semiAxis_i contains x.
  const double defect = orthonormalityDefect(box.axes);
  double square = 0;
  content.forEach([&](const Vec3& p, double) {
    const Vec3 y = local(p, e.core.center).cwiseAbs();
    const double pad = roundedUp(2 * (defect + 6 * kUnit) * y.sum() + kTiny / unit);
    const double out = (y.array() + pad).matrix().cwiseQuotient(semiAxes).squaredNorm();
    square = out < HUGE_VAL ? std::max(square, out) : HUGE_VAL;  // NaN: infinity
  });
  const double factor = roundedUp(std::sqrt(square));
  if (!(factor < HUGE_VAL)) {  // an overflow
    e.core.half.fill(HUGE_VAL);
    return e;
  }
  for (int i = 0; i < 3; ++i) e.core.half[i] = roundedUp(unit * (semiAxes[i] * factor));
  return e;
}

double Ellipsoid::radius() const {
  return roundedUp(core.half.maxCoeff() * (1 + 3 * core.axisDefect()) + size);
}

}  // namespace corridor
