#include "planner/checker/motion_validators.h"

#include <algorithm>
#include <atomic>
#include <queue>

#include <ompl/base/ScopedState.h>
#include <ompl/base/SpaceInformation.h>

#include "planner/checker/rigid_state_space.h"

namespace corridor {

namespace ob = ompl::base;

RigidMotionValidator::RigidMotionValidator(const ob::SpaceInformationPtr& si,
                                           const RigidChecker& checker)
    : MotionValidator(si), checker_(checker) {}

bool RigidMotionValidator::count(bool valid) const {
  // OMPL reads these as plain numbers, and its planners with threads call us from all of them.
  std::atomic_ref(valid ? valid_ : invalid_).fetch_add(1, std::memory_order_relaxed);
  return valid;
}

std::uint64_t RigidMotionValidator::checkedMotions() const {
  return std::uint64_t{std::atomic_ref(valid_).load(std::memory_order_relaxed)} +
         std::atomic_ref(invalid_).load(std::memory_order_relaxed);
}

bool RigidMotionValidator::checkMotion(const ob::State* s1, const ob::State* s2) const {
  return count(isFree(readState(checker_.space(), s1), readState(checker_.space(), s2)));
}

bool RigidMotionValidator::checkMotion(const ob::State* s1, const ob::State* s2,
                                       std::pair<ob::State*, double>& lastValid) const {
  const std::optional<Progress> until =
      lastFree(readState(checker_.space(), s1), readState(checker_.space(), s2));
  if (!until) return count(true);
  lastValid.second = until->t;
  if (lastValid.first && until->t > 0) {
    writeState(checker_.space(), until->state, lastValid.first);
  } else if (lastValid.first && lastValid.first != s1) {
    si_->copyState(lastValid.first, s1);
  }
  return count(false);
}

bool CertifiedMotionValidator::isFree(const RigidState& from, const RigidState& to) const {
  return checker_.inBounds(to) && checker_.edge(from, to, false).verdict == MotionVerdict::free;
}

std::optional<RigidMotionValidator::Progress> CertifiedMotionValidator::lastFree(
    const RigidState& from, const RigidState& to) const {
  if (!checker_.inBounds(to)) return Progress{};
  const MotionResult result = checker_.edge(from, to, true);
  if (result.verdict == MotionVerdict::free) return std::nullopt;
  // The tube covers the rounding of a state on the edge, so the first try nearly always holds; but
  // [0, t0] may be proved with a clearance that leaves nothing for a second proof.
  const double least = checker_.options().timeTolerance;
  for (double t = result.certifiedUntil; t >= least; t /= 2) {
    const RigidState at = interpolate(checker_.space(), from, to, t);
    if (checker_.certifiedState(at) && isFree(from, at)) return Progress{t, at};
  }
  return Progress{};
}

bool DiscreteMotionValidator::isValid(const RigidState& state) const {
  // Through OMPL, so that edges and states are judged by one rule.
  ob::ScopedState<> scoped(si_->getStateSpace());
  writeState(checker_.space(), state, scoped.get());
  return si_->isValid(scoped.get());
}

unsigned DiscreteMotionValidator::steps(const RigidState& from, const RigidState& to) const {
  ob::ScopedState<> a(si_->getStateSpace()), b(si_->getStateSpace());
  writeState(checker_.space(), from, a.get());
  writeState(checker_.space(), to, b.get());
  return std::max(1u, si_->getStateSpace()->validSegmentCount(a.get(), b.get()));
}

bool DiscreteMotionValidator::isFree(const RigidState& from, const RigidState& to) const {
  if (ambiguous(checker_.space(), from, to) || !isValid(to)) return false;
  const unsigned n = steps(from, to);
  // Middles first: contacts are found sooner there (OMPL's order).
  std::queue<std::pair<unsigned, unsigned>> parts;  // steps first … last are yet to be asked
  if (n > 1) parts.emplace(1, n - 1);
  for (; !parts.empty(); parts.pop()) {
    const auto [first, last] = parts.front();
    const unsigned middle = (first + last) / 2;
    if (!isValid(interpolate(checker_.space(), from, to, double(middle) / n))) return false;
    if (first < middle) parts.emplace(first, middle - 1);
    if (middle < last) parts.emplace(middle + 1, last);
  }
  return true;
}

std::optional<RigidMotionValidator::Progress> DiscreteMotionValidator::lastFree(
    const RigidState& from, const RigidState& to) const {
  if (ambiguous(checker_.space(), from, to)) return Progress{};
  const unsigned n = steps(from, to);
  Progress last;
  for (unsigned i = 1; i <= n; ++i) {
    const double t = double(i) / n;
    const RigidState at = interpolate(checker_.space(), from, to, t);
    if (!isValid(at)) break;
    if (i == n) return std::nullopt;
    last = {t, at};
  }
  // The shorter edge has other samples; it counts only if they are free too.
  while (last.t > 0 && !isFree(from, last.state)) {
    last.t = last.t > 1.0 / n ? last.t / 2 : 0;
    last.state = interpolate(checker_.space(), from, to, last.t);
  }
  return last;
}

}  // namespace corridor
