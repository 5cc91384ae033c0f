#include "collision/motion/adaptive_motion.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "collision/motion/distance_steps.h"
#include "collision/motion/motion_answer.h"

namespace corridor {
namespace {

/// Intervals with this half width are not halved. The middles of much shorter intervals would not
/// be exact.
constexpr double kLeastHalfWidth = 0x1p-48;

/// A time interval of a pair that is not proved yet.
struct QueuedInterval {
  double t0, t1;
  /// The distance, metres, that was missing for a proof of the interval that was halved into this
  /// one. The number is too large by the pair's margin. This matters little, because the number
  /// decides only the order of the intervals. Infinite for the whole motion.
  double need;
  std::uint32_t pair;
};

/// A time around which no interval, however short, can be proved: there is a contact, or too little
/// clearance.
struct Block {
  double time;
  std::uint32_t pair;
  DistanceSteps::Measurement measured;
};

/// One motion query, answered by bisection of time intervals.
class Bisection {
 public:
  explicit Bisection(DistanceSteps& steps) : steps_(steps), earliest_(steps.options().earliest) {}

  MotionResult run(std::size_t pairs) {
    for (std::uint32_t k = 0; k < pairs; ++k)
      if (!steps_.staysAway(k, 0.5, 0.5)) push({0, 1, HUGE_VAL, k});
    while (!queue_.empty()) {
      std::pop_heap(queue_.begin(), queue_.end(), Later{earliest_});
      const QueuedInterval w = queue_.back();
      queue_.pop_back();
      if (block_ && w.t0 >= block_->time - steps_.options().timeTolerance)
        return blocked(std::min(w.t0, block_->time));
      if (steps_.outOfWork()) return steps_.workLimit(w.t0);
      if (const auto result = decide(w)) return *result;
    }
    return block_ ? blocked(block_->time) : MotionResult{};
  }

 private:
  /// The order of the intervals. With `earliest` the earliest interval comes first: everything
  /// before it is then proved. Otherwise the interval whose parent lacked the most distance comes
  /// first, because a contact is most likely in this interval. One contact suffices, and a free
  /// motion needs the same intervals in any order.
  struct Later {
    bool earliest;
    bool operator()(const QueuedInterval& a, const QueuedInterval& b) const {
      return earliest ? a.t0 > b.t0 : a.need < b.need;
    }
  };
  void push(const QueuedInterval& w) {
    queue_.push_back(w);
    std::push_heap(queue_.begin(), queue_.end(), Later{earliest_});
  }

  /// Tests an interval. Returns nothing if the interval is proved or halved, otherwise the answer
  /// of the query.
  std::optional<MotionResult> decide(const QueuedInterval& w) {
    const double h = (w.t1 - w.t0) / 2, t = w.t0 + h;  // dyadic: exact
    const DistanceSteps::Measurement measured = steps_.measureAt(w.pair, t, h, false);
    if (measured.apart()) return std::nullopt;
    // If the motion bound is at most half of the tolerance, a clearance of twice the tolerance
    // suffices for a proof, even if the clearance slack is as large as the tolerance.
    const bool narrow = measured.bound.bound <= steps_.options().tolerance / 2,
               last = h <= kLeastHalfWidth;
    if (measured.contact && (!earliest_ || last)) return steps_.contact(w.pair, w.t0, t, measured);
    if (!measured.contact && (narrow || last || (measured.hopeless && !earliest_))) {
      if (!narrow || !block_ || !block_->measured.contact || block_->time != w.t1)
        return steps_.answerWhereStuck(w.pair, w.t0, t, measured.gap + measured.bound.bound);
      MotionResult result = blocked(w.t0);
      result.grazing = true;
      return result;
    }
    ++steps_.counters().splits;
    // `need` exceeds the missing distance by the pair's margin. This affects the order only.
    const double need = measured.bound.needed - measured.gap;
    push({w.t0, t, need, w.pair});
    // Intervals after a block are not needed.
    const bool before = !block_ || t < block_->time;
    if (before && (measured.contact || measured.hopeless))
      block_ = Block{t, w.pair, measured};
    else if (before)
      push({t, w.t1, need, w.pair});
    return std::nullopt;
  }

  /// Returns the query's answer if the search ends at the block. @pre Everything up to t0 is
  /// proved. Either t0 is as close to the block as requested, or the clearance between t0 and the
  /// block is too small for a proof.
  MotionResult blocked(double t0) {
    const auto& [time, pair, measured] = *block_;
    return measured.contact ? steps_.contact(pair, t0, time, measured)
                            : steps_.answerWhereStuck(pair, t0, time, HUGE_VAL);
  }

  DistanceSteps& steps_;
  bool earliest_;
  std::vector<QueuedInterval> queue_;  // a heap
  std::optional<Block> block_;
};

}  // namespace

MotionResult certifyAdaptively(MotionSource& motion, std::span<const MotionPair> pairs,
                               const MotionOptions& options, QueryContext& context) {
  requireValid(options, pairs.size());
  return answered(motion, options.earliest, [&] {
    DistanceSteps steps(motion, pairs, options, context);
    return Bisection(steps).run(pairs.size());
  });
}

}  // namespace corridor
