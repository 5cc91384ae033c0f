#include "planner/solve/contact_step.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "collision/core/rigid_pose.h"
#include "planner/robot/kinematic_tree.h"

namespace corridor {

namespace {

/// The number of sweeps over the pairs in each Newton step. So few are enough because there are few
/// pairs, and their gradients are similar.
constexpr int kSweeps = 20;
/// A step may fall short of the requested change by this fraction, since the sweeps only converge
/// to the change.
constexpr double kUnmet = 0.1;

/// Returns the given frames and all frames above them in the tree, in ascending order of their
/// indices.
std::vector<std::size_t> framesAbove(const KinematicTree& tree, std::vector<std::size_t> frames) {
  for (std::size_t i = 0; i < frames.size(); ++i)
    if (frames[i] != 0) frames.push_back(tree.frames[frames[i]].parent);
  std::sort(frames.begin(), frames.end());
  frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
  return frames;
}

/// Returns, for each pair, the gradient of its distance at q. The closest points are kept fixed in
/// their frames, which changes the distances only to second order.
std::vector<TangentStep> distanceGradients(const Checker& checker,
                                           const std::vector<Scene::NearPair>& near,
                                           const Configuration& q) {
  // The rounding of positions (some 1e-15 m) causes an error of the quotient of 1e-15 m /
  // kDifference. Curvature causes an error of about kDifference times the size of the robot.
  constexpr double kDifference = 1e-6;
  struct Ends {
    std::size_t frameA, frameB;
    Vec3 p_A, p_B, apart, normal;
  };
  const Scene& scene = checker.scene();
  const KinematicTree& tree = checker.model().tree;
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
  const TangentStep weights = tangentWeights(checker.space());
  const Eigen::Index size = tangentSize(checker.space());
  std::vector<TangentStep> gradients(near.size(), TangentStep::Zero(size));
  for (Eigen::Index i = 0; i < size; ++i)
    // The difference is one-sided. Near an upper bound, a step upwards would end early, so a step
    // downwards is used.
    for (const double difference : {kDifference, -kDifference}) {
      const Configuration moved =
          displaced(checker.space(), q, difference * TangentStep::Unit(size, i));
      if (checker.space().distance(q, moved) < 0.9 * kDifference * weights[i]) continue;
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

}  // namespace

std::vector<DistanceConstraint> constraintsOf(const Checker& checker,
                                              const std::vector<Scene::NearPair>& near,
                                              const Configuration& q, const TangentStep& weights) {
  const std::vector<TangentStep> gradients = distanceGradients(checker, near, q);
  std::vector<DistanceConstraint> constraints;
  for (std::size_t i = 0; i < near.size(); ++i) {
    DistanceConstraint c{near[i].pair, near[i].distance.distance, gradients[i],
                         gradients[i].cwiseQuotient(weights.cwiseAbs2())};
    c.change = c.gradient.dot(c.step);
    if (c.change > 0) constraints.push_back(std::move(c));
  }
  return constraints;
}

std::optional<TangentStep> shortestStep(std::vector<DistanceConstraint>& constraints,
                                        Eigen::Index size) {
  TangentStep step = TangentStep::Zero(size);
  for (DistanceConstraint& c : constraints) c.multiplier = 0;
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (DistanceConstraint& c : constraints) {
      const double more = std::max((c.need - c.gradient.dot(step)) / c.change, -c.multiplier);
      c.multiplier += more;
      step += more * c.step;
    }
  for (const DistanceConstraint& c : constraints)
    if (c.gradient.dot(step) < c.need - kUnmet * std::abs(c.need)) return std::nullopt;
  return step;
}

}  // namespace corridor
