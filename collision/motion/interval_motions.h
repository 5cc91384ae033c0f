#pragma once

#include <span>

#include "collision/core/query_context.h"
#include "collision/motion/certify_motion.h"
#include "collision/motion/swept_spheres.h"

namespace corridor {

/// The relative motions of a query's bodies in one time interval, each computed when it is first
/// needed, and what bounding spheres prove about whole bodies in it.
class IntervalMotions {
 public:
  IntervalMotions(MotionSource& source, std::span<const MotionPair> pairs, QueryContext& context);

  /// Selects the interval [t − h, t + h].
  void select(double t, double h);
  /// Returns motion number `motion` in the selected interval. Valid until the next call of any
  /// member.
  const RelativeMotion& relative(std::size_t motion);

  struct Separation {
    double clearance = 0;  ///< proved lower bound of the bodies' distance in the interval, metres
    /// b rotates and moves far for its size (`SplitRules`). False where `clearance` is above
    /// the value that was requested.
    bool far = false;
  };
  /// Bounds the distance of two bodies in the interval by their bounding spheres and boxes. No tree
  /// is built.
  /// @param asked  metres. A clearance above it need not be the best bound, unless `best` is true.
  Separation separation(const MotionPair& pair, double asked, bool best);

 private:
  const SweptSphere& worldSphere(std::size_t motion, const Body& body, std::size_t index);

  MotionSource& source_;
  SweptSpheres& spheres_;
  Counters& counters_;
  double t_ = -1, h_ = 0;                  // the selected interval
  RelativeMotion relative_;                // in it,
  std::size_t posed_ = MotionPair::kNone;  // of this motion
};

}  // namespace corridor
