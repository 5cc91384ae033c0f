#pragma once

#include <cstdint>
#include <span>

#include "collision/motion/certify_motion.h"

namespace corridor {

/// The common steps of the methods that prove motions by distances (adaptive_motion.h,
/// conservative_advancement.h). They measure the distance of a pair of bodies at one time, and
/// bound the motion of b about that time in any direction.
class DistanceSteps {
 public:
  /// @pre All arguments outlive the object.
  DistanceSteps(MotionSource& motion, std::span<const MotionPair> pairs,
                const MotionOptions& options, QueryContext& context);

  /// The distance that is needed at t to prove a time interval [t − h, t + h]. Metres, rounded up.
  struct Bound {
    double bound = 0;   ///< motion bound: no point of b moves farther from its place at t
    double needed = 0;  ///< sum of margin, `bound`, rounding, tube and clearance slack
  };
  Bound bound(std::uint32_t pair, double t, double h);

  /// The measurement of a pair at t, for a time interval about t. Metres.
  struct Measurement {
    Bound bound;
    /// At the rounded pose at t the bodies touch (for meshes decided exactly), or are proved to be
    /// within the margin.
    bool contact = false;
    double lower = 0;            ///< proved lower bound of the distance at the rounded pose at t
    double gap = 0;              ///< distance at t beyond the margin, as measured
    bool hopeless = false;       ///< no interval about t, however short, can be proved
    std::uint32_t s = 0, t = 0;  ///< the closest leaf primitives, by their numbers in their meshes

    /// Reports whether the interval is proved: the margin is kept throughout.
    bool apart() const { return lower > bound.needed; }
  };
  /// Measures a pair at t.
  /// @param exact If true, the distance is measured to the last digits. If false, an error of a
  /// quarter of the motion bound is allowed. This error saves tests of leaf primitives that are
  /// nearly as close as the closest ones.
  Measurement measureAt(std::uint32_t pair, double t, double h, bool exact);

  /// Reports whether the swept sphere of b stays farther than the margin from a's bounds in [t − h,
  /// t + h]. `true` is a proof. Measures no distance and builds no tree.
  bool staysAway(std::uint32_t pair, double t, double h);

  /// Reports whether `MotionOptions::workLimit` is reached. Each measurement counts as
  /// `kMeasurementWork` tests, in addition to the tests that it makes.
  bool outOfWork() const;

  const MotionOptions& options() const { return options_; }
  Counters& counters() { return context_.counters; }

  // The functions below return answers of a query. With `earliest`, the caller must have proved [0,
  // t0] free.

  MotionResult contact(std::uint32_t pair, double t0, double t1, const Measurement& seen) const;
  MotionResult workLimit(double t0) const;
  /// Returns the answer of the query if no interval that begins at t0 can be proved: `contact` if a
  /// contact is found soon after t0, otherwise `undecided`.
  /// @param time the time to report with `undecided`; the gap is measured there.
  /// @param clearance an upper bound of the clearance beyond the margin at t0, metres.
  MotionResult answerWhereStuck(std::uint32_t pair, double t0, double time, double clearance);

 private:
  static constexpr std::uint64_t kMeasurementWork = 256;

  RelativeMotion relativeMotion(std::uint32_t pair, double t, double h);
  Bound boundOf(std::uint32_t pair, const RelativeMotion& relative) const;
  std::uint64_t work() const;

  MotionSource& motion_;
  std::span<const MotionPair> pairs_;
  const MotionOptions& options_;
  QueryContext& context_;
  std::uint64_t measurements_ = 0, workEnd_ = 0;
};

}  // namespace corridor
