#include "collision/motion/interval_motions.h"

#include <cmath>

#include "collision/motion/split_rules.h"

namespace corridor {

IntervalMotions::IntervalMotions(MotionSource& source, std::size_t bodies, QueryContext& context)
    : source_(source),
      use_(context.scratch.use<SweptSpheres>()),
      spheres_(*use_),
      counters_(context.counters) {
  spheres_.makeRoom(bodies);
}

void IntervalMotions::select(double t, double h) {
  if (t == t_ && h == h_) return;
  t_ = t;
  h_ = h;
  posed_ = MotionPair::kNone;
  spheres_.forget();
}

void IntervalMotions::compute(std::size_t motion) {
  posed_ = motion;
  relative_ = source_.relativeMotion(motion, t_, h_);
  spreadNaN(relative_);
  ++counters_.poses;
}

IntervalMotions::Separation IntervalMotions::separation(const MotionPair& pair, double asked,
                                                        bool best) {
  const double enough = best ? HUGE_VAL : asked;
  const bool aHasItsOwnFrame = pair.worldMotionB != pair.motion;
  if (aHasItsOwnFrame && pair.worldMotionB != MotionPair::kNone) {
    const SweptSphere& b = worldSphere(pair);
    const double clearance =
        pair.restBox
            ? clearanceBound(*pair.restBox, b, enough)
            : clearanceBound(worldSphere(pair.worldMotionA, *pair.a, pair.bodyA), b, enough);
    if (clearance > asked) return {clearance};
  }
  // A sphere can be shared by several pairs only if its motion is seen from the world.
  const SweptSphere sphere = pair.worldMotionB == pair.motion
                                 ? worldSphere(pair.motion, *pair.b, pair.bodyB)
                                 : sweptSphere(*pair.b, relative(pair.motion));
  const bool far = sphere.isotropic > SplitRules::kFar * pair.b->sphereRadius() &&
                   sphere.angular.squaredNorm() > SplitRules::kTurns * SplitRules::kTurns;
  const double clearance = clearanceBound(*pair.a, sphere, enough);
  return {clearance, far && !(clearance > asked)};
}

}  // namespace corridor
