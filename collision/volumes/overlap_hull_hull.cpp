#include "collision/volumes/overlap_hull_hull.h"

#include <algorithm>
#include <cmath>

#include "collision/core/rounding.h"
#include "collision/volumes/direction_search.h"

namespace corridor {
namespace {

struct Extreme {
  double along = -HUGE_VAL;
  const Vec3* vertex = nullptr;
};
/// Returns the vertex farthest along n. NaN is never the farthest; callers test whether n is NaN.
Extreme farthest(const std::vector<Vec3>& vertices, const Vec3& n) {
  Extreme most{n.dot(vertices[0]), &vertices[0]};
  for (std::size_t i = 1; i < vertices.size(); ++i) {
    const double along = n.dot(vertices[i]);
    if (along > most.along) most = {along, &vertices[i]};
  }
  return most;
}

BoundingSphere sphereOf(const Hull& hull) {
  return {hull.boundingCenter, hull.boundingRadius};
}

}  // namespace

PairTest<Hull>::PairTest(const VolumeBounds& a, const VolumeBounds& b, const Transform& X_AB,
                         double error)
    : X_AB_(X_AB), spheres_(a, b, X_AB, error) {
  const BoxPairMargins margins = boxPairMargins(0, 0, 0, 0, X_AB);
  relative_ = margins.relative;
  slack_ =
      roundedUp(16 * kUnit * (a.centerReach + X_AB.m.norm() * b.centerReach + X_AB.t.stableNorm()) +
                kTiny) +
      error;
  // Overflow, or a map that is far from rigid: `relative` is not a bound then.
  if (!(margins.absolute < HUGE_VAL)) slack_ = HUGE_VAL;
}

bool PairTest<Hull>::separated(const Hull& a, const Hull& b, double pad) const {
  return spheres_.separated(sphereOf(a), sphereOf(b), pad) ||
         alongDirections(a, b, pad, pad, internal::kVerdict) > pad;
}

double PairTest<Hull>::distanceBound(const Hull& a, const Hull& b) const {
  return std::max(spheres_.distanceBound(sphereOf(a), sphereOf(b)),
                  alongDirections(a, b, 0, HUGE_VAL, internal::kBound));
}

double PairTest<Hull>::alongDirections(const Hull& a, const Hull& b, double pad, double enough,
                                       double agreed) const {
  if (!(slack_ < HUGE_VAL)) return 0;
  const double radii = a.size + b.size, loss = slack_ + radii * (1 + relative_);
  const Vec3 between = X_AB_ * b.boundingCenter - a.boundingCenter;
  const double size = between.cwiseAbs().sum() + a.boundingRadius + b.boundingRadius;
  return internal::widestGap(between, size, radii + pad, enough, agreed, [&](const Vec3& n) {
    const Vec3 m = X_AB_.m.transpose() * n;
    const Extreme p = farthest(a.vertices, n), q = farthest(b.vertices, -m);
    const double gap = (n.dot(X_AB_.t) - q.along) - p.along - loss;
    return internal::AlongDirection{roundedDown(gap), X_AB_ * *q.vertex - *p.vertex};
  });
}

}  // namespace corridor
