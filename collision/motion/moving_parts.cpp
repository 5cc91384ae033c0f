#include "collision/motion/moving_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/convex/gjk.h"
#include "collision/motion/moving_sets.h"

namespace corridor {
namespace {

MovingSets movingSets(const ConvexSet& a, const ConvexSet& b, const RelativeMotion& relative) {
  Vec3 low = b.points[0], high = low;
  for (const Vec3& p : b.points) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const Vec3 center = low + 0.5 * (high - low);
  double square = 0;
  for (const Vec3& p : b.points) square = std::max(square, (p - center).squaredNorm());
  return {a, b, relative, center, std::sqrt(square) + b.disc};
}

MovingPairAnswer decide(const ConvexSet& a, const ConvexSet& b, const RelativeMotion& relative,
                        double margin) {
  const MovingSets pair = movingSets(a, b, relative);
  const double needed = pair.needed(margin);
  const double near = pair.radii() + 0x1p-49 * pair.size();  // within the band of `convexSetsTouch`

  MovingPairAnswer answer;
  const double none = -std::numeric_limits<double>::infinity();
  Gaps best{none, none, none};
  const auto attempt = [&](const Vec3& n, double coreGap, std::uint32_t, std::uint32_t) {
    if (!(coreGap > near)) return false;
    const Gaps gaps = pair.along(n);
    best = {std::max(best.moving, gaps.moving), std::max(best.middle, gaps.middle),
            std::max(best.still, gaps.still)};
    return gaps.moving > needed;
  };
  const auto apart = [&] {
    return MovingPairAnswer{
        .separated = true, .clearance = roundedDown(best.moving - needed), .exact = answer.exact};
  };
  gjk::Answer found = gjk::search<double>(pair.a(), pair.b(), pair.size(), near, attempt);
  if (found.accepted) return apart();
  const bool met = found.overlap || found.upper <= near;
  // The sets do not meet, but the tilt of n reduces the gap to nothing, or by more than a quarter:
  // search again with more digits.
  if (!met && !(best.middle > pair.slack() &&
                best.middle - margin > 0.75 * (found.upper - pair.radii() - margin))) {
    answer.exact = true;
    found = gjk::search<DoubleDouble>(pair.a(), pair.b(), pair.size(), near, attempt);
    if (found.accepted) return apart();
  }
  const double distance = met ? 0 : std::max(0.0, found.upper - pair.radii());
  answer.bound = pair.bound().isotropic;
  answer.gap = std::max(0.0, distance - margin);
  answer.contact =
      !(best.middle > pair.slack()) || (margin > 0 && distance + pair.slack() <= margin);
  answer.stuck = !answer.contact && !(best.still > needed);
  return answer;
}

}  // namespace

MovingPairAnswer decideMovingParts(const ConvexPart& a, const ConvexPart& b,
                                   const RelativeMotion& relative, double margin) {
  return decide(a, b, relative, margin);
}

MovingPairAnswer decideMovingParts(const Triangle& a, const ConvexPart& b,
                                   const RelativeMotion& relative, double margin) {
  return decide(a, b, relative, margin);
}

MovingPairAnswer decideMovingParts(const ConvexPart& a, const Triangle& b,
                                   const RelativeMotion& relative, double margin) {
  return decide(a, b, relative, margin);
}

}  // namespace corridor
