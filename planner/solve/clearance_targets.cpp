#include "planner/solve/clearance_targets.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "collision/core/rigid_pose.h"
#include "planner/robot/kinematic_tree.h"

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
/// The number of sweeps over the pairs in each Newton step. So few are enough because there are few
/// pairs, and their gradients are similar.
constexpr int kSweeps = 20;
/// If no step reaches the aim, steps for a half, a quarter, … of the way are tried, down to this
/// part of the way.
constexpr double kLeastPart = 1.0 / 16;
/// A step may fall short of the requested change by this fraction, since the sweeps only converge
/// to the change.
constexpr double kUnmet = 0.1;
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

/// Returns the given frames and all frames above them in the tree, in ascending order of their
/// indices.
std::vector<std::size_t> framesAbove(const KinematicTree& tree, std::vector<std::size_t> frames) {
  for (std::size_t i = 0; i < frames.size(); ++i)
    if (frames[i] != 0) frames.push_back(tree.frames[frames[i]].parent);
  std::sort(frames.begin(), frames.end());
  frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
  return frames;
}

/// A pair that should get farther apart by `need` metres, to first order. The step `step` has the
/// direction of the largest change of the pair's distance, and changes this distance by `change` >
/// 0.
struct Constraint {
  std::size_t pair = 0;
  double distance = 0;
  TangentStep gradient, step;
  double change = 0, need = 0, multiplier = 0;
};

/// Returns the constraints of the pairs that a step can move apart.
std::vector<Constraint> constraintsOf(const std::vector<Scene::NearPair>& near,
                                      const std::vector<TangentStep>& gradients,
                                      const TangentStep& weights) {
  std::vector<Constraint> constraints;
  for (std::size_t i = 0; i < near.size(); ++i) {
    Constraint c{near[i].pair, near[i].distance.distance, gradients[i],
                 gradients[i].cwiseQuotient(weights.cwiseAbs2())};
    c.change = c.gradient.dot(c.step);
    if (c.change > 0) constraints.push_back(std::move(c));
  }
  return constraints;
}

/// Returns the shortest step with gradient·step ≥ need for all pairs, by Hildreth's method (1957),
/// or nullopt if it finds none.
std::optional<TangentStep> shortestStep(std::vector<Constraint>& constraints, Eigen::Index size) {
  TangentStep step = TangentStep::Zero(size);
  for (Constraint& c : constraints) c.multiplier = 0;
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (Constraint& c : constraints) {
      const double more = std::max((c.need - c.gradient.dot(step)) / c.change, -c.multiplier);
      c.multiplier += more;
      step += more * c.step;
    }
  for (const Constraint& c : constraints)
    if (c.gradient.dot(step) < c.need - kUnmet * std::abs(c.need)) return std::nullopt;
  return step;
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

/// Returns, for each pair, the gradient of its distance: one entry for each number of a step. The
/// closest points are kept fixed in their frames, which changes the distances only to second order.
std::vector<TangentStep> ClearanceTargets::gradientsOf(const std::vector<Scene::NearPair>& near,
                                                       const Configuration& q) const {
  // The rounding of positions (some 1e-15 m) causes an error of the quotient of 1e-15 m /
  // kDifference. Curvature causes an error of about kDifference times the size of the robot.
  constexpr double kDifference = 1e-6;
  struct Ends {
    std::size_t frameA, frameB;
    Vec3 p_A, p_B, apart, normal;
  };
  const Scene& scene = checker_.scene();
  const KinematicTree& tree = checker_.model().tree;
  std::vector<std::size_t> frames;
  for (const Scene::NearPair& pair : near)
    for (const std::size_t body :
         {scene.motionPairs()[pair.pair].bodyA, scene.motionPairs()[pair.pair].bodyB})
      frames.push_back(scene.bodies()[body].frame);
  frames = framesAbove(tree, std::move(frames));
  std::vector<Transform> X_WF(tree.frames.size());
  setFramePoses(tree, q, frames, X_WF);
  std::vector<Ends> ends;
  for (const Scene::NearPair& pair : near) {
    const std::size_t a = scene.bodies()[scene.motionPairs()[pair.pair].bodyA].frame,
                      b = scene.bodies()[scene.motionPairs()[pair.pair].bodyB].frame;
    const Vec3 apart = pair.distance.p_WB - pair.distance.p_WA;
    ends.push_back({a, b, rigidInverse(X_WF[a]) * pair.distance.p_WA,
                    rigidInverse(X_WF[b]) * pair.distance.p_WB, apart,
                    apart.norm() > 0 ? Vec3(apart.normalized()) : Vec3(Vec3::Zero())});
  }
  const Eigen::Index size = weights_.size();
  std::vector<TangentStep> gradients(near.size(), TangentStep::Zero(size));
  for (Eigen::Index i = 0; i < size; ++i)
    // The difference is one-sided. Near an upper bound, a step upwards would end early, so a step
    // downwards is used.
    for (const double difference : {kDifference, -kDifference}) {
      const Configuration moved =
          displaced(checker_.space(), q, difference * TangentStep::Unit(size, i));
      if (checker_.space().distance(q, moved) < 0.9 * kDifference * weights_[i]) continue;
      setFramePoses(tree, moved, frames, X_WF);
      for (std::size_t k = 0; k < ends.size(); ++k) {
        const Ends& e = ends[k];
        gradients[k][i] =
            e.normal.dot(X_WF[e.frameB] * e.p_B - X_WF[e.frameA] * e.p_A - e.apart) / difference;
      }
      break;
    }
  return gradients;
}

std::optional<Configuration> ClearanceTargets::movedApart(const Configuration& q) const {
  Configuration moved = q;
  for (int n = 0; n < kSteps; ++n) {
    const std::vector<Scene::NearPair> near = checker_.pairsWithin(moved, near_);
    double share = kAim;
    for (const Scene::NearPair& pair : near)
      share = std::min(share, pair.distance.distance / targets_[pair.pair]);
    if (share >= kAim) break;
    std::vector<Constraint> constraints = constraintsOf(near, gradientsOf(near, moved), weights_);
    // In a narrow passage, not all pairs can reach the aim. The aim is then lowered towards
    // `share`.
    std::optional<TangentStep> step;
    for (double part = 1; !step && part >= kLeastPart; part /= 2) {
      for (Constraint& c : constraints)
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
