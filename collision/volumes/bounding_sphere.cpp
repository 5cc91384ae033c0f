#include "collision/volumes/bounding_sphere.h"

#include <algorithm>
#include <cmath>

#include "collision/core/rounding.h"

namespace corridor {
namespace {

constexpr int kSphereSteps = 16;  // more steps shrink the sphere only slowly

}  // namespace

BoundingSphere BoundingSphere::around(const Obb& box, const Content& content) {
  // The unit of length is a power of two near the size, so that squares neither overflow nor
  // underflow. Scaling by this unit is exact.
  const double largest = box.half.maxCoeff();
  const double unit = powerOfTwo(largest);
  BoundingSphere best{box.center, HUGE_VAL};
  Vec3 center = box.center;
  for (int step = 1; step <= kSphereSteps; ++step) {
    double farthest = -1;
    Vec3 towards = Vec3::Zero();
    content.forEach([&](const Vec3& p, double r) {
      const Vec3 d = (p - center) / unit;
      const double reach = d.norm() + r / unit;
      if (!(reach > farthest)) return;
      farthest = reach;
      towards = d;
    });
    if (farthest < 0) break;  // the centre is NaN, after an overflow
    // Eight roundings: the difference, three squares, two sums, the root, and the sum with r.
    const double size = roundedUp(farthest * unit);
    if (size < best.size) best = {center, size};
    center += unit / (step + 1) * towards;
  }
  return best;
}

}  // namespace corridor
