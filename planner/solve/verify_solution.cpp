#include "planner/solve/verify_solution.h"

#include <algorithm>
#include <cmath>

#include "planner/checker/default_tolerance.h"
#include "planner/problem/bounds.h"
#include "planner/problem/yaml_reader.h"
#include "planner/verify/edge_curve.h"

namespace corridor {
namespace {

using Real = long double;
using RealQuaternion = Eigen::Matrix<Real, 4, 1>;

/// A start's quaternion is normalised in double on its way into a path: an angle of under 32·2^-53,
/// see `inGoal`.
constexpr Real kSameAngle = 0x1p-46L;
/// Whether a state on the rim of a goal region is inside hangs on rounding: 2^-44 of the radius.
constexpr Real kRim = 1 + 0x1p-44L;

/// Angle between the quaternions' lines: half that of the rotation between them.
Real quaternionAngle(const Configuration& a, const Configuration& b, std::size_t first) {
  const auto i = static_cast<Eigen::Index>(first);
  const RealQuaternion p = a.segment<4>(i).cast<Real>().normalized(),
                       q = b.segment<4>(i).cast<Real>().normalized();
  return 2 * std::atan2(std::min((p - q).norm(), (p + q).norm()),
                        std::max((p - q).norm(), (p + q).norm()));
}

/// How far coordinate `c` is from a to b: its difference, the angle of its rotation.
Real awayIn(const Coordinate& c, const Configuration& a, const Configuration& b) {
  const auto i = static_cast<Eigen::Index>(c.first);
  switch (c.kind) {
    case Coordinate::Kind::line:
      return std::abs(Real(b[i]) - Real(a[i]));
    case Coordinate::Kind::circle:
      return std::abs(verify::circleWay(a[i], b[i]));
    case Coordinate::Kind::rotation:
      return 2 * quaternionAngle(a, b, c.first);
  }
  return 0;
}

/// How far apart two configurations are: the largest of each kind.
struct Away {
  Real position = 0, angle = 0, joint = 0;
  Real distance = 0;    ///< with the space's weights
  Real jointAngle = 0;  ///< of `joint`, that of circles: off by rounding when they are brought back
};

Away awayFrom(const ConfigurationSpace& space, const Configuration& a, const Configuration& b) {
  Away away;
  for (const CoordinateGroup& group : space.groups()) {
    Real squares = 0, weighted = 0, angle = 0, weightedAngle = 0;
    for (const std::size_t k : group.coordinates) {
      const Coordinate& c = space.coordinates()[k];
      const Real d = awayIn(c, a, b);
      if (group.kind == CoordinateGroup::Kind::joints) {
        weighted += c.weight * d * c.weight * d;
        if (c.kind == Coordinate::Kind::circle)
          away.jointAngle = std::max(away.jointAngle, d);
        else
          away.joint = std::max(away.joint, d);
      } else if (c.kind == Coordinate::Kind::line) {
        squares += d * d;
        weighted += c.weight * d * c.weight * d;
      } else {
        angle = d;
        weightedAngle = c.weight * (c.kind == Coordinate::Kind::rotation ? d / 2 : d);
      }
    }
    away.position = std::max(away.position, std::sqrt(squares));
    away.angle = std::max(away.angle, angle);
    away.distance += std::sqrt(weighted) + weightedAngle;
  }
  return away;
}

std::string inFact(const Away& away) {
  std::string text;
  const auto add = [&](Real value, const char* what) {
    if (value > 0) text += (text.empty() ? "" : ", ") + shortest(static_cast<double>(value)) + what;
  };
  add(away.position, " m");
  add(away.angle, " rad");
  add(std::max(away.joint, away.jointAngle), " in a joint");
  return "it is " + (text.empty() ? "0" : text) + " away";
}

bool isSame(const Away& away) {
  return away.position == 0 && away.joint == 0 && away.angle <= kSameAngle &&
         away.jointAngle <= kSameAngle;
}

bool isInGoal(const Problem& problem, const Away& away) {
  if (problem.goalRegion) {
    const Problem::GoalRegion& region = *problem.goalRegion;
    return away.position <= region.position * kRim &&
           away.angle <= std::max(region.angle * kRim, kSameAngle) &&
           away.joint <= region.joint * kRim &&
           away.jointAngle <= std::max(region.joint * kRim, kSameAngle);
  }
  if (problem.goalThreshold && away.distance <= *problem.goalThreshold * kRim) return true;
  return isSame(away);
}

/// @returns whether the path's end is in the goal.
bool checkEnds(const Problem& problem, const Path& path, std::vector<std::string>& violations) {
  const Away start = awayFrom(problem.space, problem.start, path.front());
  if (!isSame(start)) violations.push_back("the first state is not the start: " + inFact(start));
  Away nearest;
  nearest.distance = HUGE_VALL;
  for (const Configuration& goal : problem.goals) {
    const Away away = awayFrom(problem.space, goal, path.back());
    if (isInGoal(problem, away)) return true;
    if (away.distance < nearest.distance) nearest = away;
  }
  violations.push_back("the last state is not in the goal: " + inFact(nearest));
  return false;
}

void checkBounds(const Problem& problem, const Path& path, std::vector<std::string>& violations) {
  for (std::size_t i = 0; i < path.size(); ++i) {
    const auto outside = [&](const std::string& name, double value, double lower, double upper) {
      violations.push_back("state " + std::to_string(i) + " is outside of the bounds: " + name +
                           " = " + shortest(value) + " is not in [" + shortest(lower) + ", " +
                           shortest(upper) + "]");
    };
    for (const Coordinate& c : problem.space.coordinates()) {
      if (c.kind != Coordinate::Kind::line) continue;
      const double value = path[i][static_cast<Eigen::Index>(c.first)];
      if (!(value >= c.lower && value <= c.upper)) outside(c.name, value, c.lower, c.upper);
    }
    for (const FollowerOutside& f : followersOutside(problem, path[i]))
      outside(f.name, f.value, f.lower, f.upper);
  }
}

/// Half the diagonal of the box around a shape.
double sizeOf(const VerifyBody& body) {
  Vec3 lower = Vec3::Constant(HUGE_VAL), upper = -lower;
  for (const Vec3& p : body.mesh ? body.mesh->vertices : body.part->points) {
    lower = lower.cwiseMin(p);
    upper = upper.cwiseMax(p);
  }
  return 0.5 * (upper - lower).norm() + (body.part ? body.part->radius : 0);
}

/// A tenth of what the planner calls too close to tell (1e-7 of the smaller body, or
/// what rounding needs, unless the problem says otherwise), so that its paths are decided.
double toleranceOf(const Problem& problem, const PathProblem& plain) {
  if (problem.checker.tolerance) return 0.1 * *problem.checker.tolerance;
  double smallest = 1;
  for (const VerifyPair& pair : plain.pairs)
    for (const std::size_t body : {pair.a, pair.b})
      if (const double size = sizeOf(plain.bodies[body]); size > 0)
        smallest = std::min(smallest, size);
  return 0.1 * defaultTolerance(problem, 1e-7 * smallest);
}

}  // namespace

PathProblem plainProblem(const Problem& problem) {
  PathProblem plain;
  plain.tree = &problem.tree;
  plain.space = &problem.space;
  plain.margin = problem.margin;
  plain.tube = problem.tube;
  std::vector<std::vector<std::size_t>> parts;  // of each body: its shapes
  for (const ProblemBody& body : problem.bodies) {
    parts.emplace_back();
    for (const PlacedShape& shape : body.shapes) {
      parts.back().push_back(plain.bodies.size());
      plain.bodies.push_back({body.name, shape.mesh ? &shape.mesh->mesh : nullptr,
                              shape.part ? &*shape.part : nullptr, shape.solid, body.frame});
    }
  }
  for (const ProblemPair& pair : problem.pairs) {
    if (!pair.skipped.empty()) continue;
    for (const std::size_t a : parts[pair.a])
      for (const std::size_t b : parts[pair.b]) plain.pairs.push_back({a, b});
  }
  plain.tolerance = toleranceOf(problem, plain);
  return plain;
}

const char* nameOf(DigestState state) {
  return state == DigestState::same ? "same" : state == DigestState::differs ? "differs" : "none";
}

DigestState digestState(const Problem& problem, const Solution& solution) {
  if (solution.digest.empty()) return DigestState::none;
  return solution.digest == problem.digest ? DigestState::same : DigestState::differs;
}

const char* nameOf(PathVerdict verdict) {
  return verdict == PathVerdict::proved    ? "proved"
         : verdict == PathVerdict::refuted ? "refuted"
                                           : "undecided";
}

const char* verdictName(const VerifyReport& report) {
  return report.otherProblem ? "other problem" : nameOf(report.verdict);
}

VerifyReport verifySolution(const Problem& problem, const Solution& solution, OtherDigest other) {
  VerifyReport report;
  report.margin = problem.margin;
  report.tube = problem.tube;
  report.digest = digestState(problem, solution);
  report.otherProblem = report.digest == DigestState::differs && other == OtherDigest::refused;
  if (report.otherProblem) {
    report.verdict = report.motion.verdict = PathVerdict::undecided;
    report.motion.edges = static_cast<int>(solution.path.size()) - 1;
    std::vector<std::string> unused;
    report.reachesGoal = checkEnds(problem, solution.path, unused);  // for pictures
    return report;
  }
  report.reachesGoal = checkEnds(problem, solution.path, report.violations);
  checkBounds(problem, solution.path, report.violations);
  report.motion = verifyPath(plainProblem(problem), solution.path);
  report.verdict = report.violations.empty() ? report.motion.verdict : PathVerdict::refuted;
  return report;
}

}  // namespace corridor
