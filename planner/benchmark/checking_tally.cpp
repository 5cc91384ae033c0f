#include "planner/benchmark/checking_tally.h"

#include <chrono>

#include <ompl/base/MotionValidator.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/StateValidityChecker.h>

namespace corridor {

namespace ob = ompl::base;

namespace {

/// Adds the lifetime of the object to the tally, unless another `Timed` of the same thread exists
/// when the object is created.
class Timed {
 public:
  explicit Timed(CheckingTally& tally) : tally_(tally) {
    if (depth_++ == 0) start_ = Clock::now();
  }
  ~Timed() {
    if (--depth_ == 0)
      tally_.nanoseconds += std::chrono::nanoseconds(Clock::now() - start_).count();
  }
  Timed(const Timed&) = delete;
  Timed& operator=(const Timed&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  static thread_local int depth_;
  CheckingTally& tally_;
  Clock::time_point start_;
};
thread_local int Timed::depth_ = 0;

class TimedStates final : public ob::StateValidityChecker {
 public:
  TimedStates(const ob::SpaceInformationPtr& si, CheckingTally& tally)
      : StateValidityChecker(si), inner_(si->getStateValidityChecker()), tally_(tally) {
    specs_ = inner_->getSpecs();
  }
  bool isValid(const ob::State* state) const override {
    const Timed timed(tally_);
    ++tally_.states;
    return inner_->isValid(state);
  }
  double clearance(const ob::State* state) const override {
    const Timed timed(tally_);
    return inner_->clearance(state);
  }

 private:
  ob::StateValidityCheckerPtr inner_;
  CheckingTally& tally_;
};

class TimedMotions final : public ob::MotionValidator {
 public:
  TimedMotions(const ob::SpaceInformationPtr& si, CheckingTally& tally)
      : MotionValidator(si), inner_(si->getMotionValidator()), tally_(tally) {}
  bool checkMotion(const ob::State* s1, const ob::State* s2) const override {
    const Timed timed(tally_);
    return count(inner_->checkMotion(s1, s2));
  }
  bool checkMotion(const ob::State* s1, const ob::State* s2,
                   std::pair<ob::State*, double>& lastValid) const override {
    const Timed timed(tally_);
    return count(inner_->checkMotion(s1, s2, lastValid));
  }

 private:
  /// Counts a motion. OMPL reads its own counts of valid and invalid motions from this validator,
  /// not from `inner_`, so they are kept here, too.
  bool count(bool valid) const {
    ++tally_.motions;
    std::atomic_ref(valid ? valid_ : invalid_).fetch_add(1, std::memory_order_relaxed);
    return valid;
  }

  ob::MotionValidatorPtr inner_;
  CheckingTally& tally_;
};

}  // namespace

void tallyChecks(const ob::SpaceInformationPtr& si, CheckingTally& tally) {
  si->setStateValidityChecker(std::make_shared<TimedStates>(si, tally));
  si->setMotionValidator(std::make_shared<TimedMotions>(si, tally));
}

}  // namespace corridor
