#include "collision/convex/convex_contact.h"

#include "collision/convex/gjk.h"
#include "collision/convex/quick_contact.h"

namespace corridor {

PredicateResult convexSetsTouch(const PosedSet& a, const PosedSet& b, ConvexCache* cache) {
  if (!cache)
    if (const auto quick = quickContact(a, b)) return {*quick, false};
  const double size = a.reach() + a.pose().t.norm() + b.reach() + b.pose().t.norm();
  double radii = a.set().ball + b.set().ball;
  // `slack` bounds the errors of both projections and of their sum. Neither projection exceeds
  // `size`.
  const double slack = roundedUp(a.error() + b.error() + 2 * kUnit * size);
  const auto apart = [&](const Vec3& n, double gap, std::uint32_t pointA, std::uint32_t pointB) {
    return gap > radii && -b.highest(-n, pointB) - a.highest(n, pointA) > slack;
  };
  // `near` is well within the band, because `size` is below (1 + √3)·2√3 < 9.5 times the largest
  // coordinate.
  double near = radii + 0x1p-49 * size;
  gjk::Answer quick = gjk::search<double>(a, b, size, near, apart, false, cache);
  if (quick.accepted) return {false, false};
  const bool ballsInCores = !(a.keepsBall() && b.keepsBall());
  // The search above measures the distance of the cores. It assumes that the maps do not change the
  // radii of the swept spheres. If a map makes an ellipsoid of a sphere, this search may report a
  // contact that does not exist. So the search is repeated with the ellipsoids as parts of the
  // cores.
  if (ballsInCores) {
    radii = 0;
    near = 0x1p-49 * size;
    quick = gjk::search<double>(a, b, size, near, apart, ballsInCores);
    if (quick.accepted) return {false, false};
  }
  if (quick.overlap || quick.upper <= near) return {true, false};
  return {!gjk::search<DoubleDouble>(a, b, size, near, apart, ballsInCores).accepted, true};
}

}  // namespace corridor
