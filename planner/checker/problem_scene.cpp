#include "planner/checker/problem_scene.h"

#include <algorithm>
#include <numbers>

#include "collision/core/rounding.h"

namespace corridor {
namespace {

std::vector<Body> bodies(const std::vector<ProblemMesh>& meshes, const ObbTreeParams& params) {
  std::vector<Body> made;
  for (const ProblemMesh& mesh : meshes) made.emplace_back(mesh.name, mesh.source.mesh, params);
  return made;
}

RigidState stateOf(const Problem& problem, const RigidPose& pose, double yaw) {
  RigidState state{pose, yaw};
  if (problem.space == RigidSpace::SE2) {
    state.pose.p.z() = 0;
    state.pose.q.setIdentity();
  } else {
    state.pose.q.normalize();
  }
  return state;
}

}  // namespace

Scene makeScene(const Problem& problem) {
  ObbTreeParams params;
  params.fit = problem.checker.fit == "vertices" ? ObbFit::vertices
               : problem.checker.fit == "hull"   ? ObbFit::hull
                                                 : ObbFit::triangles;
  return Scene(bodies(problem.robot, params), bodies(problem.world, params));
}

MotionOptions motionOptions(const Problem& problem, const Scene& scene) {
  const int dimension = problem.space == RigidSpace::SE3 ? 3 : 2;
  MotionOptions options;
  options.tolerance = problem.checker.tolerance.value_or(scene.defaultTolerance());
  // What is called free keeps the tolerance, which may be undecided anyway: so no returned path
  // hangs on its last digits, and proving one again takes work in proportion to its length over the
  // tolerance.
  options.reserve = options.tolerance;
  options.margin = problem.margin;
  const Tube asked = problem.tube.value_or(Tube{});
  options.tube.position = std::max(
      asked.position, 0x1p-40 * (problem.upper - problem.lower).head(dimension).maxCoeff());
  options.tube.rotation = std::max(asked.rotation, 0x1p-40 * 2 * std::numbers::pi);
  return options;
}

RigidState startState(const Problem& problem) {
  return stateOf(problem, problem.start, problem.startYaw);
}
RigidState goalState(const Problem& problem) {
  return stateOf(problem, problem.goal, problem.goalYaw);
}

bool inGoal(const Problem& problem, const RigidState& state, double slack) {
  const RigidState goal = goalState(problem);
  const double grow = 1 + slack;
  const double away = (state.pose.p - goal.pose.p).norm(),
               turned = rotationAngle(problem.space, goal, state);
  // Normalising a quaternion is off by less than 4u a component, an angle of two such by less than
  // 32u, and finding it by as much.
  const double same = 64 * kUnit;
  if (problem.goalRegion)
    return away <= problem.goalRegion->position * grow &&
           turned <= std::max(problem.goalRegion->angle * grow, same);
  if (problem.goalThreshold)
    return distance(problem.space, problem.rotationWeight, goal, state) <=
           *problem.goalThreshold * grow;
  return away == 0 && turned <= same;
}

}  // namespace corridor
