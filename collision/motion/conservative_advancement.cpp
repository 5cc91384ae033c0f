#include "collision/motion/conservative_advancement.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "collision/motion/distance_steps.h"
#include "collision/motion/motion_answer.h"

namespace corridor {
namespace {

/// Times are multiples of 2^-48 of the motion, so that the ends of steps are exact.
constexpr double kGrid = 0x1p-48;
/// The largest half width of an interval that `MotionSource::relativeMotion` accepts.
constexpr double kLongest = 0.5;
/// A step that is too long is shortened in proportion to the clearance, and then multiplied by this
/// factor. (The motion bound of a short step is nearly proportional to time.)
constexpr double kShare = 1 - 0x1p-7;

/// A pair of bodies that is proved free on all of [0, t].
struct Progress {
  double t;
  std::uint32_t pair;

  // Puts the pair that is proved for the shortest time on top of a heap.
  friend bool operator<(const Progress& a, const Progress& b) { return a.t > b.t; }
};

/// One motion query, answered by conservative advancement.
class Advancement {
 public:
  explicit Advancement(DistanceSteps& steps) : steps_(steps) {}

  MotionResult run(std::size_t pairs) {
    std::vector<Progress> open;
    for (std::uint32_t k = 0; k < pairs; ++k)
      if (!steps_.staysAway(k, 0.5, 0.5)) open.push_back({0, k});
    while (!open.empty()) {
      std::pop_heap(open.begin(), open.end());
      Progress& first = open.back();
      const auto [t, pair] = first;
      if (steps_.outOfWork()) return steps_.workLimit(t);
      const DistanceSteps::Measurement measured = steps_.measureAt(pair, t, 0, true);
      if (measured.contact) return steps_.contact(pair, t, t, measured);
      const double step = longestStep(first, measured);
      const bool done = t + step == 1;
      // If the clearance is twice the tolerance, `room` exceeds half of the tolerance, even if the
      // clearance slack takes one tolerance.
      const double room = measured.lower - measured.bound.needed;
      if (!done && (step == 0 || room <= steps_.options().tolerance / 2))
        return steps_.answerWhereStuck(pair, t, t, measured.gap);
      first.t += step;
      if (done)
        open.pop_back();
      else
        std::push_heap(open.begin(), open.end());
    }
    return {};
  }

 private:
  /// Returns the longest step, or nearly the longest, for which the measured distance suffices.
  /// Returns 0 if there is none.
  double longestStep(const Progress& progress, const DistanceSteps::Measurement& measured) {
    if (!measured.apart()) return 0;
    double h = std::min(kLongest, 1 - progress.t);
    for (;;) {
      const double needed = steps_.bound(progress.pair, progress.t, h).needed;
      if (measured.lower > needed) return h;
      const double shorter =
          kShare * h *
          ((measured.lower - measured.bound.needed) / (needed - measured.bound.needed));
      if (!(shorter >= kGrid)) return 0;  // also for NaN
      h = std::floor(shorter / kGrid) * kGrid;
    }
  }

  DistanceSteps& steps_;
};

}  // namespace

MotionResult certifyByAdvancement(MotionSource& motion, std::span<const MotionPair> pairs,
                                  const MotionOptions& options, QueryContext& context) {
  requireValid(options, pairs.size());
  return answered(motion, options.earliest, [&] {
    DistanceSteps steps(motion, pairs, options, context);
    return Advancement(steps).run(pairs.size());
  });
}

}  // namespace corridor
