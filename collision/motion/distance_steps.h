#pragma once

#include <cstdint>
#include <span>

#include "collision/motion/certify_motion.h"

namespace corridor {

/// What the methods that prove motions by distances (adaptive_motion.h, conservative_advancement.h)
/// have in common: they measure the distance of a pair of bodies at one time, and bound the motion
/// of b from there in any direction.
class DistanceSteps {
 public:
  /// @pre all arguments outlive the object.
  DistanceSteps(MotionSource& motion, std::span<const MotionPair> pairs,
                const MotionOptions& options, QueryContext& context);

  /// The distance that a time interval [t − h, t + h] needs at t. Metres, rounded up.
  struct Bound {
    double bound = 0;   ///< no point of b moves farther from its place at t
    double needed = 0;  ///< margin, `bound`, rounding, tube and clearance slack
  };
  Bound bound(std::uint32_t pair, double t, double h);

  /// A pair as measured at t, for a time interval about t. Metres.
  struct Measurement {
    Bound bound;
    bool contact = false;  ///< contact at the rounded pose at t: exact, or proved within the margin
    double lower = 0;      ///< proved lower bound of the distance at the rounded pose at t
    double gap = 0;        ///< distance at t beyond the margin, as measured
    bool hopeless = false;       ///< no interval about t, however short, can be proved
    std::uint32_t s = 0, t = 0;  ///< the closest leaf primitives, by their numbers in their meshes

    /// Reports whether the interval is proved: the margin is kept throughout.
    bool apart() const { return lower > bound.needed; }
  };
  /// Measures a pair at t.
  /// @param exact measure to the last digits; otherwise to a quarter of the bound, which avoids
  /// testing pairs that are only a little farther apart than the closest.
  Measurement measureAt(std::uint32_t pair, double t, double h, bool exact);

  /// Reports whether the swept sphere of b stays apart from a's bounds in [t − h, t + h]. `true` is
  /// a proof. Measures nothing and builds no tree.
  bool staysAway(std::uint32_t pair, double t, double h);

  /// Reports whether `MotionOptions::workLimit` is reached. A measurement counts as `kLookWork`
  /// tests, in addition to those that it makes.
  bool outOfWork() const;

  const MotionOptions& options() const { return options_; }
  Counters& counters() { return context_.counters; }

  // Answers. [0, t0] is proved free if `earliest` is requested.

  MotionResult contact(std::uint32_t pair, double t0, double t1, const Measurement& seen) const;
  MotionResult workLimit(double t0) const;
  /// Returns the answer if what begins at t0 cannot be proved: contact, if one is found soon after
  /// t0, else undecided.
  /// @param time the time to report with `undecided`; the gap is measured there.
  /// @param clearance an upper bound of the clearance beyond the margin at t0, metres.
  MotionResult close(std::uint32_t pair, double t0, double time, double clearance);

 private:
  static constexpr std::uint64_t kLookWork = 256;

  RelativeMotion relativeMotion(std::uint32_t pair, double t, double h);
  Bound boundOf(std::uint32_t pair, const RelativeMotion& relative) const;
  std::uint64_t work() const;

  MotionSource& motion_;
  std::span<const MotionPair> pairs_;
  const MotionOptions& options_;
  QueryContext& context_;
  std::uint64_t looks_ = 0, workEnd_ = 0;
};

}  // namespace corridor
