#pragma once

#include "collision/core/query_context.h"
#include "collision/motion/certify_motion.h"
#include "collision/motion/may_meet.h"
#include "collision/motion/swept_spheres.h"

namespace corridor {

/// The relative motions of a query's bodies in one time interval, and proved lower bounds of the
/// distances of whole bodies. A motion is computed when it is requested; only the last one is kept.
class IntervalMotions {
 public:
  /// @param bodies one more than the largest index of a body in the query's pairs.
  IntervalMotions(MotionSource& source, std::size_t bodies, QueryContext& context);

  /// Selects the interval [t − h, t + h].
  void select(double t, double h);
  /// Returns motion number `motion` in the selected interval. The reference is valid until the next
  /// call of any member.
  const RelativeMotion& relative(std::size_t motion) {
    if (motion != posed_) compute(motion);
    return relative_;
  }

  /// Returns the swept sphere of body b of a pair, as seen from the world. @pre `pair.worldMotionB`
  /// is not `kNone`.
  const SweptSphere& worldSphere(const MotionPair& pair) {
    return worldSphere(pair.worldMotionB, *pair.b, pair.bodyB);
  }

  struct Separation {
    double clearance = 0;  ///< proved lower bound of the bodies' distance in the interval, metres
    /// True if b rotates, and moves far compared with its size (`SplitRules::kFar`). Always false
    /// if `clearance` is above the requested value.
    bool far = false;
  };
  /// Returns a lower bound of the distance of two bodies in the interval, from their bounding
  /// spheres and boxes. No tree is built.
  /// @param asked metres. If the clearance is above this value, the result need not be the best
  /// bound, unless `best` is true.
  Separation separation(const MotionPair& pair, double asked, bool best);

 private:
  void compute(std::size_t motion);
  const SweptSphere& worldSphere(std::size_t motion, const Body& body, std::size_t index) {
    return spheres_.of(index, [&] { return sweptSphere(body, relative(motion)); });
  }

  MotionSource& source_;
  Scratch::Use<SweptSpheres> use_;
  SweptSpheres& spheres_;
  Counters& counters_;
  double t_ = -1, h_ = 0;                  // the selected interval
  RelativeMotion relative_;                // motion number `posed_` in the selected interval
  std::size_t posed_ = MotionPair::kNone;  // `kNone`: no motion is computed yet
};

}  // namespace corridor
