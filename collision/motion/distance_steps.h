#pragma once

#include <cstdint>
#include <span>

#include "collision/motion/certify_motion.h"

namespace corridor {

/// What the methods that prove motions by distances share: adaptive_motion.h and
/// conservative_advancement.h. A pair of bodies is measured at one time, and how far b goes from
/// there is bounded whatever the direction.
class DistanceSteps {
 public:
  /// All must outlive the object.
  DistanceSteps(MotionSource& motion, std::span<const MotionPair> pairs,
                const MotionOptions& options, QueryContext& context);

  /// What a window [t − h, t + h] asks of the distance at t. Metres, rounded up.
  struct Bound {
    double travel = 0;  ///< no point of b goes farther from where it is at t
    double needed = 0;  ///< the margin, that, and rounding, tube and reserve
  };
  Bound bound(std::uint32_t pair, double t, double h);

  /// A pair as measured at t, for a window about it. Metres.
  struct Look {
    Bound bound;
    bool contact = false;        ///< at the rounded pose at t: exactly, or proved within the margin
    double lower = 0;            ///< proved: so far are the two apart, at the rounded pose at t
    double gap = 0;              ///< distance at t beyond the margin, as measured
    bool hopeless = false;       ///< no window about t, however short, can be proved
    std::uint32_t s = 0, t = 0;  ///< the closest triangles, by their numbers in their meshes

    /// The window is proved: the margin is kept all along it.
    bool apart() const { return lower > bound.needed; }
  };
  /// @param exact measures to the last digits; else to a quarter of the travel, which saves looking
  /// at what is only a little farther away.
  Look look(std::uint32_t pair, double t, double h, bool exact);

  /// Do balls and boxes of the two stay apart in [t − h, t + h]? Nothing is measured, no tree is
  /// built. `true` is a proof.
  bool staysAway(std::uint32_t pair, double t, double h);

  /// Too much has been done (`MotionOptions::workLimit`). A look counts as `kLookWork` tests
  /// besides those that it makes.
  bool outOfWork() const;

  const MotionOptions& options() const { return options_; }
  Counters& counters() { return context_.counters; }

  // Answers, with [0, t0] proved free where `earliest` is asked for.

  MotionResult contact(std::uint32_t pair, double t0, double t1, const Look& seen) const;
  MotionResult workLimit(double t0) const;
  /// What begins at t0 can't be proved: contact, if one is found soon after, or else undecided.
  /// @param time the middle or the end of it, to be told.
  /// @param clearance beyond the margin, at t0, an upper bound.
  MotionResult close(std::uint32_t pair, double t0, double time, double clearance);

 private:
  static constexpr std::uint64_t kLookWork = 256;

  MotionWindow window(std::uint32_t pair, double t, double h);
  Bound boundOf(std::uint32_t pair, const MotionWindow& window) const;
  std::uint64_t work() const;

  MotionSource& motion_;
  std::span<const MotionPair> pairs_;
  const MotionOptions& options_;
  QueryContext& context_;
  std::uint64_t looks_ = 0, workEnd_ = 0;
};

}  // namespace corridor
