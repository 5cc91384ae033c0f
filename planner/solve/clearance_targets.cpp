#include "planner/solve/clearance_targets.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "planner/solve/contact_step.h"

namespace corridor {

namespace {

/// A pair should keep this fraction of the smaller of its distances at the two ends of the path.
constexpr double kShareOfEnds = 0.7;
/// How far pairs are moved apart, in multiples of their targets. The path near such a state then
/// keeps the targets as well.
constexpr double kAim = 1.5;
/// A step away from obstacles takes pairs into account that are closer than this multiple of their
/// targets.
constexpr double kNear = 2;
/// The maximum number of Newton steps of `movedApart`.
constexpr int kSteps = 3;
/// If no step reaches the aim, steps for a half, a quarter, … of the way are tried, down to this
/// part of the way.
constexpr double kLeastPart = 1.0 / 16;
/// The longest Newton step of `movedApart`, in the space's distance: for arms, radians if one joint
/// of weight 1 moves.
constexpr double kLongestStep = 0.5;
/// An edge gets one sample for each 0.05 of its length (in the space's distance), but at least
/// kLeastSamples and at most kMostSamples.
constexpr double kSampleLength = 0.05;
constexpr int kLeastSamples = 4, kMostSamples = 32;
/// The share that is returned for an edge if a target could not be proved, although no sampled
/// distance is below its target.
constexpr double kJustMissed = 0.99;
/// The number of times that the step between samples is halved, in the search for the time with the
/// smallest share.
constexpr int kRefinements = 4;

/// The steps of a search around a time, halved from the widest to the narrowest.
constexpr double kWidest = 1.0 / 32, kNarrowest = 1.0 / 4096;

/// Returns the targets of all pairs. @param smallestAtEnds receives the smallest distance at start
/// and goal, if this is below `clearance`; otherwise it is not changed.
PairMargins targetsOf(const Checker& checker, double clearance, const Configuration& start,
                      const Configuration& goal, double& smallestAtEnds) {
  std::vector<double> targets(checker.scene().motionPairs().size(), clearance);
  const PairMargins within(std::vector(targets.size(), clearance / kShareOfEnds));
  for (const Configuration* end : {&start, &goal})
    for (const Scene::NearPair& near : checker.pairsWithin(*end, within)) {
      const double distance = near.distance.distance;
      targets[near.pair] = std::min(targets[near.pair], kShareOfEnds * distance);
      if (distance < clearance) smallestAtEnds = std::min(smallestAtEnds, distance);
    }
  // A target is never below the pair's padding.
  if (const PairMargins* padding = checker.options().pairMargins)
    for (std::size_t k = 0; k < targets.size(); ++k)
      targets[k] = std::max(targets[k], (*padding)[k]);
  return PairMargins(std::move(targets));
}

}  // namespace

const char* nameOf(WhyOffTarget why) {
  constexpr const char* kNames[] = {"", "detour", "not found", "time"};
  return kNames[static_cast<std::size_t>(why)];
}

ClearanceTargets::ClearanceTargets(const Checker& checker, double clearance,
                                   const Configuration& start, const Configuration& goal)
    : checker_(checker),
      clearance_(clearance),
      smallestAtEnds_(std::numeric_limits<double>::infinity()),
      targets_(targetsOf(checker, clearance, start, goal, smallestAtEnds_)),
      reserved_(scaled(1 + kReserve)),
      clearances_(std::vector(targets_.size(), clearance)),
      near_(targets_.all()),
      weights_(tangentWeights(checker.space())) {
  std::vector<double> near = targets_.all();
  for (double& length : near) length *= kNear;
  near_ = PairMargins(std::move(near));
}

PairMargins ClearanceTargets::scaled(double factor) const {
  std::vector<double> lengths = targets_.all();
  const PairMargins* padding = checker_.options().pairMargins;
  for (std::size_t k = 0; k < lengths.size(); ++k) {
    const double least = padding ? (*padding)[k] : 0;
    if (lengths[k] > least) lengths[k] = std::max(factor * lengths[k], least);
  }
  return PairMargins(std::move(lengths));
}

/// Measures the pairs at a time of an edge. If the ratio distance / entry in `lengths` of one is
/// below `worst.share`, sets `worst` to it. @param pairs null: all
void ClearanceTargets::sampleAt(const Configuration& from, const Configuration& to, double t,
                                const PairMargins& lengths, const std::vector<std::uint32_t>* pairs,
                                Worst& worst) const {
  if (t < 0 || t > 1) return;
  for (const Scene::NearPair& near : checker_.pairsWithin(checker_.space().interpolate(from, to, t),
                                                          lengths, {pairs, worst.share}))
    if (const double share = near.distance.distance / lengths[near.pair]; share < worst.share)
      worst = {share, t, near.distance.distance, near.pair};
}

/// Searches an edge for the pair and the time at which distance / entry in `lengths` is the
/// smallest: at samples, and then around the sample with the smallest ratio. If no ratio is below
/// 1, returns a `Worst` with the share 1.
/// @param pairs the pairs that are searched.
/// @param enough the search ends once a ratio is below this one.
/// @param first a time to sample first.
ClearanceTargets::Worst ClearanceTargets::worstOn(
    const Configuration& from, const Configuration& to, const PairMargins& lengths,
    const std::vector<std::uint32_t>& pairs, double enough, std::optional<double> first) const {
  const ConfigurationSpace& space = checker_.space();
  const double length = space.distance(from, to), samples = std::ceil(length / kSampleLength);
  const int count = static_cast<int>(std::clamp<double>(samples, kLeastSamples, kMostSamples));
  Worst worst;
  const auto sample = [&](double t) {
    if (worst.share >= enough) sampleAt(from, to, t, lengths, &pairs, worst);
  };
  if (first) sample(*first);
  for (int i = 0; i <= (length > 0 ? count : 0); ++i) sample(double(i) / count);
  double step = 0.5 / count;
  for (int k = 0; k < kRefinements && worst.share < 1 && length > 0; ++k, step /= 2) {
    const double t = worst.t;
    sample(t - step);
    sample(t + step);
  }
  return worst;
}

std::optional<ClearanceTargets::Worst> ClearanceTargets::missedOn(const Configuration& from,
                                                                  const Configuration& to,
                                                                  double enough) const {
  // Hulls and samples go first: they answer most edges, and are quicker than a proof that fails.
  const std::vector<std::uint32_t> pairs = checker_.pairsLeftByHulls(from, to, reserved_);
  if (pairs.empty() && !checker_.scene().pairs().empty()) return std::nullopt;
  Worst worst = worstOn(from, to, reserved_, pairs, enough);
  if (worst.share < 1) return worst;
  const MotionResult result = checker_.certifyEdge(from, to, {.margins = &reserved_});
  if (result.verdict == MotionVerdict::free) return std::nullopt;
  if (result.time < 0) return worst;
  // The samples missed it. They may meet it near the place where the proof fails.
  worst = worstOn(from, to, reserved_, pairs, enough, result.time);
  if (worst.share >= 1) {
    worst.t = result.time;
    worst.share = kJustMissed;
  }
  return worst;
}

std::optional<ClearanceTargets::Worst> ClearanceTargets::closestOn(const Configuration& from,
                                                                   const Configuration& to) const {
  const Worst closest =
      worstOn(from, to, clearances_, checker_.pairsLeftByHulls(from, to, clearances_));
  if (closest.share < 1) return closest;
  return std::nullopt;
}

std::optional<ClearanceTargets::Worst> ClearanceTargets::closestNear(const Configuration& from,
                                                                     const Configuration& to,
                                                                     double t) const {
  Worst closest;
  const auto sample = [&](double at) { sampleAt(from, to, at, clearances_, nullptr, closest); };
  sample(t);
  for (double step = kWidest; step >= kNarrowest; step /= 2) {
    const double middle = closest.share < 1 ? closest.t : t;
    sample(middle - step);
    sample(middle + step);
  }
  if (closest.share < 1) return closest;
  return std::nullopt;
}

double ClearanceTargets::least() const {
  const std::vector<double>& all = targets_.all();
  return all.empty() ? clearance_ : *std::min_element(all.begin(), all.end());
}

std::optional<Configuration> ClearanceTargets::movedApart(const Configuration& q) const {
  Configuration moved = q;
  for (int n = 0; n < kSteps; ++n) {
    const std::vector<Scene::NearPair> near = checker_.pairsWithin(moved, near_);
    double share = kAim;
    for (const Scene::NearPair& pair : near)
      share = std::min(share, pair.distance.distance / targets_[pair.pair]);
    if (share >= kAim) break;
    std::vector<DistanceConstraint> constraints = constraintsOf(checker_, near, moved, weights_);
    // In a narrow passage, not all pairs can reach the aim. The aim is then lowered towards
    // `share`.
    std::optional<TangentStep> step;
    for (double part = 1; !step && part >= kLeastPart; part /= 2) {
      for (DistanceConstraint& c : constraints)
        c.need = (share + part * (kAim - share)) * targets_[c.pair] - c.distance;
      step = shortestStep(constraints, weights_.size());
    }
    if (!step) break;
    const double length = step->cwiseProduct(weights_).norm();
    if (length > kLongestStep) *step *= kLongestStep / length;
    moved = displaced(checker_.space(), moved, *step);
  }
  if (moved == q) return std::nullopt;
  return moved;
}

}  // namespace corridor
