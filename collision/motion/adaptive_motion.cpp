#include "collision/motion/adaptive_motion.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "collision/motion/distance_steps.h"
#include "collision/motion/motion_answer.h"

namespace corridor {
namespace {

/// Half windows are not halved below 2^-48 of the motion: much below, their middles would no longer
/// be exact.
constexpr double kShortest = 0x1p-48;

/// A window of time of a pair that is not proved yet.
struct Window {
  double t0, t1;
  double need;  ///< metres that its parent's distance fell short by
  std::uint32_t pair;
};

/// A time at which nothing will ever be proved: a contact, or a clearance that leaves no room.
struct Block {
  double time;
  std::uint32_t pair;
  DistanceSteps::Look look;
};

class Bisection {
 public:
  explicit Bisection(DistanceSteps& steps) : steps_(steps), earliest_(steps.options().earliest) {}

  MotionResult run(std::size_t pairs) {
    for (std::uint32_t k = 0; k < pairs; ++k)
      if (!steps_.staysAway(k, 0.5, 0.5)) push({0, 1, HUGE_VAL, k});
    while (!queue_.empty()) {
      std::pop_heap(queue_.begin(), queue_.end(), Later{earliest_});
      const Window w = queue_.back();
      queue_.pop_back();
      if (block_ && w.t0 >= block_->time - steps_.options().timeTolerance)
        return blocked(std::min(w.t0, block_->time));
      if (steps_.outOfWork()) return steps_.workLimit(w.t0);
      if (const auto result = decide(w)) return *result;
    }
    return block_ ? blocked(block_->time) : MotionResult{};
  }

 private:
  /// Which window comes first? Where the first contact is asked for, the earliest: all before it is
  /// proved then. For the verdict alone, the one whose parent fell short by the most: a contact, if
  /// there is one, is likeliest there, and one is enough. A free motion takes the same windows in
  /// any order.
  struct Later {
    bool earliest;
    bool operator()(const Window& a, const Window& b) const {
      return earliest ? a.t0 > b.t0 : a.need < b.need;
    }
  };
  void push(const Window& w) {
    queue_.push_back(w);
    std::push_heap(queue_.begin(), queue_.end(), Later{earliest_});
  }

  /// Nothing: the window is proved, or halved.
  std::optional<MotionResult> decide(const Window& w) {
    const double h = (w.t1 - w.t0) / 2, t = w.t0 + h;  // dyadic: exact
    const DistanceSteps::Look look = steps_.look(w.pair, t, h, false);
    if (look.apart()) return std::nullopt;
    // Half the tolerance: where a reserve of one is kept, a clearance of two is enough then.
    const bool narrow = look.bound.travel <= steps_.options().tolerance / 2, last = h <= kShortest;
    if (look.contact && (!earliest_ || last)) return steps_.contact(w.pair, w.t0, t, look);
    if (!look.contact && (narrow || last || (look.hopeless && !earliest_))) {
      if (!narrow || !block_ || !block_->look.contact || block_->time != w.t1)
        return steps_.close(w.pair, w.t0, t, look.gap + look.bound.travel);
      MotionResult result = blocked(w.t0);
      result.grazing = true;
      return result;
    }
    ++steps_.counters().splits;
    const double need = look.bound.needed - look.gap;  // the margin, in the former, is all pairs'
    push({w.t0, t, need, w.pair});
    // What is after a block doesn't matter any more.
    const bool before = !block_ || t < block_->time;
    if (before && (look.contact || look.hopeless))
      block_ = Block{t, w.pair, look};
    else if (before)
      push({t, w.t1, need, w.pair});
    return std::nullopt;
  }

  /// All is proved up to t0, and the block is as near to it as was asked for.
  MotionResult blocked(double t0) {
    const auto& [time, pair, look] = *block_;
    return look.contact ? steps_.contact(pair, t0, time, look)
                        : steps_.close(pair, t0, time, HUGE_VAL);
  }

  DistanceSteps& steps_;
  bool earliest_;
  std::vector<Window> queue_;  // a heap
  std::optional<Block> block_;
};

}  // namespace

MotionResult certifyByBisection(MotionSource& motion, std::span<const MotionPair> pairs,
                                const MotionOptions& options, QueryContext& context) {
  return answered(motion, options.earliest, context, [&] {
    DistanceSteps steps(motion, pairs, options, context);
    return Bisection(steps).run(pairs.size());
  });
}

}  // namespace corridor
