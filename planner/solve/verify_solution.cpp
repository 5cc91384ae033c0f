#include "planner/solve/verify_solution.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "planner/problem/yaml_reader.h"

namespace corridor {
namespace {

using Real = long double;
using RealVec = Eigen::Matrix<Real, 3, 1>;
using RealQuaternion = Eigen::Matrix<Real, 4, 1>;

/// A start's quaternion is normalised in double on its way into a path: an angle of under 32·2^-53,
/// see `inGoal`.
constexpr Real kSameAngle = 0x1p-46L;
/// Whether a state on the rim of a goal region is inside hangs on rounding: 2^-44 of the radius.
constexpr Real kRim = 1 + 0x1p-44L;

Real away(const Vec3& a, const Vec3& b) {
  return (b.cast<Real>() - a.cast<Real>()).norm();
}

/// Angle between the quaternions' lines: half that of the rotation between them.
Real quaternionAngle(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  const RealQuaternion p = a.coeffs().cast<Real>().normalized(),
                       q = b.coeffs().cast<Real>().normalized();
  return 2 * std::atan2(std::min((p - q).norm(), (p + q).norm()),
                        std::max((p - q).norm(), (p + q).norm()));
}

Real turned(const Problem& problem, const RigidPose& pose, double yaw, const RigidState& state) {
  if (problem.space == RigidSpace::SE3) return 2 * quaternionAngle(pose.q, state.pose.q);
  return std::abs(std::remainder(Real(state.yaw) - Real(yaw), 2 * std::numbers::pi_v<Real>));
}

std::string inFact(Real metres, Real radians) {
  return "it is " + shortest(static_cast<double>(metres)) + " m and " +
         shortest(static_cast<double>(radians)) + " rad away";
}

void checkEnds(const Problem& problem, const Path& path, std::vector<std::string>& violations) {
  const bool planar = problem.space == RigidSpace::SE2;
  const auto flat = [&](Vec3 p) { return planar ? Vec3(p.x(), p.y(), 0) : p; };
  const Real startAway = away(flat(problem.start.p), path.front().pose.p);
  const Real startTurned = turned(problem, problem.start, problem.startYaw, path.front());
  if (startAway > 0 || startTurned > kSameAngle)
    violations.push_back("the first state is not the start: " + inFact(startAway, startTurned));

  const Real goalAway = away(flat(problem.goal.p), path.back().pose.p);
  const Real goalTurned = turned(problem, problem.goal, problem.goalYaw, path.back());
  bool inside = goalAway == 0 && goalTurned <= kSameAngle;
  if (problem.goalRegion)
    inside = goalAway <= problem.goalRegion->position * kRim &&
             goalTurned <= std::max(problem.goalRegion->angle * kRim, kSameAngle);
  else if (problem.goalThreshold)
    inside = inside || goalAway + problem.rotationWeight * (planar ? goalTurned : goalTurned / 2) <=
                           *problem.goalThreshold * kRim;
  if (!inside)
    violations.push_back("the last state is not in the goal: " + inFact(goalAway, goalTurned));
}

void checkBounds(const Problem& problem, const Path& path, std::vector<std::string>& violations) {
  for (std::size_t i = 0; i < path.size(); ++i)
    for (int k = 0; k < (problem.space == RigidSpace::SE3 ? 3 : 2); ++k)
      if (!(path[i].pose.p[k] >= problem.lower[k] && path[i].pose.p[k] <= problem.upper[k])) {
        violations.push_back("state " + std::to_string(i) + " is outside of the bounds: " +
                             "xyz"[k] + " = " + shortest(path[i].pose.p[k]) + " is not in [" +
                             shortest(problem.lower[k]) + ", " + shortest(problem.upper[k]) + "]");
      }
}

PathReport checkMotion(const Problem& problem, const Path& path, const Tube& tube) {
  PathProblem plain;
  for (const ProblemMesh& mesh : problem.robot)
    plain.moving.push_back({mesh.name, &mesh.source.mesh});
  for (const ProblemMesh& mesh : problem.world)
    plain.fixed.push_back({mesh.name, &mesh.source.mesh});
  plain.margin = problem.margin;
  plain.tube = tube;
  plain.tolerance = problem.checker.tolerance.value_or(0);
  if (problem.space == RigidSpace::SE2) {
    std::vector<Vec3> states;
    for (const RigidState& state : path) states.push_back(state.xyYaw());
    return verifyPath(plain, states);
  }
  std::vector<RigidPose> states;
  for (const RigidState& state : path) states.push_back(state.pose);
  return verifyPath(plain, states);
}

}  // namespace

VerifyReport verifySolution(const Problem& problem, const Solution& solution) {
  VerifyReport report;
  report.margin = problem.margin;
  // As the contract has it, written down a second time: 2^-40 of each coordinate's range at least.
  const int dimension = problem.space == RigidSpace::SE3 ? 3 : 2;
  report.tube = problem.tube.value_or(Tube{});
  report.tube.position = std::max(
      report.tube.position, 0x1p-40 * (problem.upper - problem.lower).head(dimension).maxCoeff());
  report.tube.rotation = std::max(report.tube.rotation, 0x1p-40 * 2 * std::numbers::pi);
  checkEnds(problem, solution.path, report.violations);
  checkBounds(problem, solution.path, report.violations);
  report.motion = checkMotion(problem, solution.path, report.tube);
  report.verdict = report.violations.empty() ? report.motion.verdict : PathVerdict::refuted;
  return report;
}

}  // namespace corridor
