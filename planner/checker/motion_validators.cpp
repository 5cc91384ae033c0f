#include "planner/checker/motion_validators.h"

#include <algorithm>
#include <atomic>
#include <queue>

#include <ompl/base/ScopedState.h>
#include <ompl/base/SpaceInformation.h>

#include "planner/checker/problem_state_space.h"

namespace corridor {

namespace ob = ompl::base;

CountingMotionValidator::CountingMotionValidator(const ob::SpaceInformationPtr& si,
                                                 const Checker& checker)
    : MotionValidator(si), checker_(checker) {
  requireProblemStateSpace(*si, checker.space());
}

void CountingMotionValidator::write(const Configuration& q, ob::State* state) const {
  si_->getStateSpace()->as<ProblemStateSpace>()->write(q, state);
}

bool CountingMotionValidator::count(bool valid) const {
  // OMPL declares the two counters as plain numbers, and its multi-threaded planners call this
  // function from all their threads. So the counters are changed by atomic operations.
  std::atomic_ref(valid ? valid_ : invalid_).fetch_add(1, std::memory_order_relaxed);
  return valid;
}

std::uint64_t CountingMotionValidator::checkedMotions() const {
  return std::uint64_t{std::atomic_ref(valid_).load(std::memory_order_relaxed)} +
         std::atomic_ref(invalid_).load(std::memory_order_relaxed);
}

bool CountingMotionValidator::checkMotion(const ob::State* s1, const ob::State* s2) const {
  return count(isFree(configurationOf(*si_, s1), configurationOf(*si_, s2)));
}

bool CountingMotionValidator::checkMotion(const ob::State* s1, const ob::State* s2,
                                          std::pair<ob::State*, double>& lastValid) const {
  const std::optional<FreePart> until =
      lastFree(configurationOf(*si_, s1), configurationOf(*si_, s2));
  if (!until) return count(true);
  lastValid.second = until->t;
  if (lastValid.first && until->t > 0) {
    write(until->state, lastValid.first);
  } else if (lastValid.first && lastValid.first != s1) {
    si_->copyState(lastValid.first, s1);
  }
  return count(false);
}

bool CertifiedMotionValidator::isFree(const Configuration& from, const Configuration& to) const {
  return checker_.inBounds(to) && checker_.certifyEdge(from, to).verdict == MotionVerdict::free;
}

std::optional<CountingMotionValidator::FreePart> CertifiedMotionValidator::lastFree(
    const Configuration& from, const Configuration& to) const {
  if (!checker_.inBounds(to)) return FreePart{};
  const MotionResult result = checker_.certifyEdge(from, to, {.earliest = true});
  if (result.verdict == MotionVerdict::free) return std::nullopt;
  // The edge is proved free on [0, certifiedUntil]. The loop tries to prove the state at the end of
  // this interval, and the shorter edge to this state. The tube covers the rounding of the state,
  // so the first try nearly always succeeds. The first try fails if the clearance is too small for
  // a second proof, which can happen because the method `advancement` goes as close to contact as
  // it can. Then the loop goes back from certifiedUntil by a small step, and doubles the step after
  // each failure.
  const double least = checker_.options().timeTolerance;
  for (double back = 0; result.certifiedUntil - back >= least; back = back > 0 ? 2 * back : least) {
    const double t = result.certifiedUntil - back;
    const Configuration at = checker_.space().interpolate(from, to, t);
    if (checker_.isProvedFree(at) && isFree(from, at)) return FreePart{t, at};
  }
  return FreePart{};
}

bool DiscreteMotionValidator::isValid(const Configuration& state) const {
  // This uses OMPL's state validity checker, so that single states and the samples of edges obey
  // the same rule.
  ob::ScopedState<> scoped(si_->getStateSpace());
  write(state, scoped.get());
  return si_->isValid(scoped.get());
}

unsigned DiscreteMotionValidator::steps(const Configuration& from, const Configuration& to) const {
  ob::ScopedState<> a(si_->getStateSpace()), b(si_->getStateSpace());
  write(from, a.get());
  write(to, b.get());
  return std::max(1u, si_->getStateSpace()->validSegmentCount(a.get(), b.get()));
}

bool DiscreteMotionValidator::isFree(const Configuration& from, const Configuration& to) const {
  if (checker_.space().ambiguous(from, to) || !isValid(to)) return false;
  const unsigned n = steps(from, to);
  // The middle of each range of steps is tested first, as in OMPL: this order finds contacts
  // sooner.
  std::queue<std::pair<unsigned, unsigned>> parts;  // ranges of untested steps: first, last
  if (n > 1) parts.emplace(1, n - 1);
  for (; !parts.empty(); parts.pop()) {
    const auto [first, last] = parts.front();
    const unsigned middle = (first + last) / 2;
    if (!isValid(checker_.space().interpolate(from, to, double(middle) / n))) return false;
    if (first < middle) parts.emplace(first, middle - 1);
    if (middle < last) parts.emplace(middle + 1, last);
  }
  return true;
}

std::optional<CountingMotionValidator::FreePart> DiscreteMotionValidator::lastFree(
    const Configuration& from, const Configuration& to) const {
  if (checker_.space().ambiguous(from, to)) return FreePart{};
  const unsigned n = steps(from, to);
  FreePart last;
  for (unsigned i = 1; i <= n; ++i) {
    const double t = double(i) / n;
    const Configuration at = checker_.space().interpolate(from, to, t);
    if (!isValid(at)) break;
    if (i == n) return std::nullopt;
    last = {t, at};
  }
  // The shorter edge from `from` to `last` has other samples than the whole edge. These other
  // samples must be free, too.
  while (last.t > 0 && !isFree(from, last.state)) {
    last.t = last.t > 1.0 / n ? last.t / 2 : 0;
    last.state = checker_.space().interpolate(from, to, last.t);
  }
  return last;
}

}  // namespace corridor
