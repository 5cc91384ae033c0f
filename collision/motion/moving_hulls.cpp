#include "collision/motion/moving_hulls.h"

#include "collision/convex/gjk.h"
#include "collision/core/rounding.h"
#include "collision/motion/moving_sets.h"

namespace corridor {
namespace {

/// Halves are left untested if the motion exceeds the gap by at most this factor: four levels of
/// halving make up for it.
constexpr double kFewHalvings = 16;

}  // namespace

bool haveHulls(const Body& a, const Body& b) {
  const auto mayHave = [](const Body& body) { return body.isMesh() || body.parts().size() == 1; };
  return (a.isMesh() || b.isMesh()) && mayHave(a) && mayHave(b) && a.hull() && b.hull();
}

MovingHullsAnswer decideMovingHulls(const Body& a, const Body& b, const RelativeMotion& relative,
                                    double margin, HullGuess& guess) {
  // The points of a mesh's hull may be outside of its sphere by the radius that sweeps them.
  const double beyond = b.isMesh() ? b.hull()->ball : 0;
  const MovingSets sets(*a.hull(), *b.hull(), relative, b.sphereCenter(),
                        roundedUp(b.sphereRadius() + beyond));
  const double needed = sets.needed(margin);
  double best = -HUGE_VAL;
  const auto attempt = [&](const Vec3& n, double coreGap, std::uint32_t, std::uint32_t) {
    if (!(coreGap - sets.radii() - sets.bound().pad > needed)) return false;
    best = sets.moving(n);
    if (best > needed) guess.normal = n;
    return best > needed;
  };
  const auto apart = [&] {
    return MovingHullsAnswer{.separated = true, .clearance = roundedDown(best - needed)};
  };
  if (!guess.normal.isZero(0) && attempt(guess.normal, HUGE_VAL, 0, 0)) return apart();
  // The search ends when the gap is known to a tenth: a better direction rarely proves more.
  const double near = sets.radii() + needed;
  const auto enough = [&](double upper, double lower) {
    return upper <= near || upper - lower <= 0.1 * lower;
  };
  gjk::Search<double> search(sets.a(), sets.b(), sets.size());
  const gjk::Answer found = search.run(gjk::startOf<double>(&guess.cache), enough, attempt);
  gjk::keep(search.simplex, &guess.cache);
  if (found.accepted) return apart();
  const double gap = found.lower - sets.radii() - sets.bound().pad - needed;
  if (!(gap > 0)) guess.met = true;
  return {.apart = gap > 0, .shorter = gap > 0 && sets.bound().isotropic < kFewHalvings * gap};
}

}  // namespace corridor
