#include "collision/volumes/bounding_sphere.h"

#include <algorithm>
#include <cmath>

#include "collision/core/rounding.h"

namespace corridor {
namespace {

constexpr int kSteps = 16;  // the excess over the smallest sphere falls like 1/steps

}  // namespace

BoundingSphere BoundingSphere::around(const Obb& box, const Content& content) {
  // In a power-of-two unit near the size, so that squares neither over- nor underflow: exact to
  // undo.
  const double largest = box.half.maxCoeff();
  const double unit = powerOfTwo(largest);
  BoundingSphere best{box.center, HUGE_VAL};
  Vec3 center = box.center;
  for (int step = 1; step <= kSteps; ++step) {
    double farthest = -1;
    Vec3 towards = Vec3::Zero();
    content.forEach([&](const Vec3& p, double r) {
      const Vec3 d = (p - center) / unit;
      const double reach = d.norm() + r / unit;
      if (!(reach > farthest)) return;
      farthest = reach;
      towards = d;
    });
    // The difference, three squares, two sums, the root and the sum with r: 8 roundings.
    const double size = roundedUp(farthest * unit);
    if (size < best.size) best = {center, size};
    center += unit / (step + 1) * towards;
  }
  return best;
}

}  // namespace corridor
