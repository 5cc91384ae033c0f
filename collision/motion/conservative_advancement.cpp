#include "collision/motion/conservative_advancement.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "collision/motion/distance_steps.h"
#include "collision/motion/motion_answer.h"

namespace corridor {
namespace {

/// Times are whole numbers of 2^-48 of the motion, so that those at which steps end are exact.
constexpr double kGrid = 0x1p-48;
/// What windows are told for, at most, on either side of their middles.
constexpr double kLongest = 0.5;
/// A step that is too long is shortened to this share of what the room would allow if the travel
/// were in proportion to the time, which it is for short ones.
constexpr double kShare = 1 - 0x1p-7;

/// A pair that is proved for all of [0, t].
struct Front {
  double t;
  std::uint32_t pair;

  friend bool operator<(const Front& a, const Front& b) {  // the earliest is the top of a heap
    return a.t > b.t;
  }
};

class Advancement {
 public:
  explicit Advancement(DistanceSteps& steps) : steps_(steps) {}

  MotionResult run(std::size_t pairs) {
    std::vector<Front> fronts;
    for (std::uint32_t k = 0; k < pairs; ++k)
      if (!steps_.staysAway(k, 0.5, 0.5)) fronts.push_back({0, k});
    while (!fronts.empty()) {
      std::pop_heap(fronts.begin(), fronts.end());
      Front& front = fronts.back();
      const auto [t, pair] = front;
      if (steps_.outOfWork()) return steps_.workLimit(t);
      const DistanceSteps::Look look = steps_.look(pair, t, 0, true);
      if (look.contact) return steps_.contact(pair, t, t, look);
      const double step = longestStep(front, look);
      const bool done = t + step == 1;
      // A clearance of twice the tolerance, of which reserve may be one, leaves more room.
      const double room = look.lower - look.bound.needed;
      if (!done && (step == 0 || room <= steps_.options().tolerance / 2))
        return steps_.close(pair, t, t, look.gap);
      front.t += step;
      if (done)
        fronts.pop_back();
      else
        std::push_heap(fronts.begin(), fronts.end());
    }
    return {};
  }

 private:
  /// For how long the distance at t is enough: nearly the longest such time, or 0.
  double longestStep(const Front& front, const DistanceSteps::Look& look) {
    if (!look.apart()) return 0;
    double h = std::min(kLongest, 1 - front.t);
    for (;;) {
      const double needed = steps_.bound(front.pair, front.t, h).needed;
      if (look.lower > needed) return h;
      const double shorter =
          kShare * h * ((look.lower - look.bound.needed) / (needed - look.bound.needed));
      if (!(shorter >= kGrid)) return 0;  // NaN, too
      h = std::floor(shorter / kGrid) * kGrid;
    }
  }

  DistanceSteps& steps_;
};

}  // namespace

MotionResult certifyByAdvancement(MotionSource& motion, std::span<const MotionPair> pairs,
                                  const MotionOptions& options, QueryContext& context) {
  return answered(motion, options.earliest, context, [&] {
    DistanceSteps steps(motion, pairs, options, context);
    return Advancement(steps).run(pairs.size());
  });
}

}  // namespace corridor
