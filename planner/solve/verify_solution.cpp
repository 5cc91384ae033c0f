#include "planner/solve/verify_solution.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "collision/core/shortest.h"
#include "planner/checker/default_tolerance.h"
#include "planner/model/pair_proofs.h"
#include "planner/problem/digest.h"
#include "planner/problem/yaml_reader.h"
#include "planner/robot/angles.h"
#include "planner/solve/keep_clearance.h"
#include "planner/solve/outside_bounds.h"
#include "planner/verify/edge_curve.h"

namespace corridor {
namespace {

using Real = long double;
using RealQuaternion = Eigen::Matrix<Real, 4, 1>;

/// Orientations count as equal if the angle between them is at most this, rad. A path's quaternions
/// are normalised in double, which rotates them by less than 32·2^-53 against the start or goal as
/// read (derived in problem_goal.cpp).
constexpr Real kSameAngle = 0x1p-46L;
/// The radius of a goal region is enlarged by 2^-44 of the radius. Otherwise rounding would decide
/// whether a state on its rim is inside.
constexpr Real kRim = 1 + 0x1p-44L;

/// Returns the angle between the lines through two quaternions: half the angle of the rotation
/// between the orientations.
Real quaternionAngle(const Configuration& a, const Configuration& b, std::size_t first) {
  const auto i = static_cast<Eigen::Index>(first);
  const RealQuaternion p = a.segment<4>(i).cast<Real>().normalized(),
                       q = b.segment<4>(i).cast<Real>().normalized();
  return 2 * std::atan2(std::min((p - q).norm(), (p + q).norm()),
                        std::max((p - q).norm(), (p + q).norm()));
}

/// Returns the distance from a to b in coordinate `c`: the absolute difference, or the rotation
/// angle.
Real awayIn(const Coordinate& c, const Configuration& a, const Configuration& b) {
  const auto i = static_cast<Eigen::Index>(c.first);
  switch (c.kind) {
    case Coordinate::Kind::line:
      return std::abs(Real(b[i]) - Real(a[i]));
    case Coordinate::Kind::circle:
      return std::abs(verify::circleDifference(a[i], b[i]));
    case Coordinate::Kind::rotation:
      return 2 * quaternionAngle(a, b, c.first);
  }
  return 0;
}

/// The difference of two configurations: the largest difference of each kind of coordinate.
struct Away {
  /// `position` (m) and `angle` (rad) of planar and floating joints; `joint` (rad or m) of single
  /// joints, except continuous ones.
  Real position = 0, angle = 0, joint = 0;
  Real distance = 0;  ///< distance in the configuration space, with its weights
  /// The largest difference of continuous joints, rad. It is separate from `joint`, because the
  /// angles of continuous joints are rounded when they are reduced to one revolution.
  Real jointAngle = 0;
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

std::string awayText(const Away& away) {
  std::string text;
  const auto add = [&](Real value, const char* what) {
    if (value > 0) text += (text.empty() ? "" : ", ") + shortest(static_cast<double>(value)) + what;
  };
  add(away.position, " m");
  add(away.angle, " rad");
  add(std::max(away.joint, away.jointAngle),
      away.joint < away.jointAngle ? " rad in a joint" : " rad or m in a joint");
  return "it differs by " + (text.empty() ? "0" : text);
}

bool isSame(const Away& away) {
  return away.position == 0 && away.joint == 0 && away.angle <= kSameAngle &&
         away.jointAngle <= kSameAngle;
}

bool isInGoal(const Problem& problem, const Away& away) {
  if (problem.task.goalRegion) {
    const GoalRegion& region = *problem.task.goalRegion;
    return away.position <= region.position * kRim &&
           away.angle <= std::max(region.angle * kRim, kSameAngle) &&
           away.joint <= region.joint * kRim &&
           away.jointAngle <= std::max(region.joint * kRim, kSameAngle);
  }
  if (problem.task.goalThreshold && away.distance <= *problem.task.goalThreshold * kRim)
    return true;
  return isSame(away);
}

/// Returns how far a state is from the start, such as "it differs by 0.1 m"; "" if it is the start.
std::string notStart(const Problem& problem, const Configuration& state) {
  const Away away = awayFrom(problem.model.space, problem.task.start, state);
  return isSame(away) ? "" : awayText(away);
}

/// Returns how far a state is from the nearest goal; "" if it is in a goal.
std::string notInGoal(const Problem& problem, const Configuration& state) {
  Away nearest;
  nearest.distance = HUGE_VALL;
  for (const Configuration& goal : problem.task.goals) {
    const Away away = awayFrom(problem.model.space, goal, state);
    if (isInGoal(problem, away)) return "";
    if (away.distance < nearest.distance) nearest = away;
  }
  return awayText(nearest);
}

/// Checks that the path begins at the start and ends in the goal, and adds violations if not.
/// @returns whether the path ends in the goal.
bool checkEnds(const Problem& problem, const Path& path, std::vector<std::string>& violations) {
  if (const std::string away = notStart(problem, path.front()); !away.empty())
    violations.push_back("the first state is not the start: " + away);
  const std::string away = notInGoal(problem, path.back());
  if (!away.empty()) violations.push_back("the last state is not in the goal: " + away);
  return away.empty();
}

std::string boundsText(const Coordinate& c) {
  return "[" + shortest(c.lower) + ", " + shortest(c.upper) + "]";
}

/// Returns a hint if a value is out of bounds, but would be within them if it were meant in
/// degrees. Otherwise returns "".
std::string degreesHintOf(const Coordinate& c, double value) {
  return c.angular && fitsAsDegrees(value, c.lower, c.upper)
             ? "; is it in degrees? These files have radians"
             : "";
}

void checkBounds(const Problem& problem, const Path& path, std::vector<std::string>& violations) {
  for (std::size_t i = 0; i < path.size(); ++i) {
    for (const Coordinate& c : problem.model.space.coordinates()) {
      if (c.kind != Coordinate::Kind::line) continue;
      const double value = path[i][static_cast<Eigen::Index>(c.first)];
      if (value >= c.lower && value <= c.upper) continue;
      violations.push_back("state " + std::to_string(i) + " is outside of the bounds: " + c.name +
                           " = " + shortest(value) + " is not in " + boundsText(c) +
                           degreesHintOf(c, value));
    }
  }
}

/// Adds violations for the coordinates of a trajectory that leave their bounds, at rows or between
/// rows.
void checkBounds(const ConfigurationSpace& space, const TrajectoryRows& rows, const Curve& curve,
                 std::vector<std::string>& violations) {
  for (const OutsideBounds& outside : outsideBounds(space, curve.pieces)) {
    const Coordinate& c = space.coordinates()[outside.coordinate];
    const std::size_t p = outside.piece;
    const double first = curve.knots[p], last = curve.knots[p + 1];
    const int line = rows.rows[outside.t < 1 ? p : p + 1].line;
    const std::string when =
        rows.timed ? "at " + shortest(first + outside.t * (last - first)) + " s, " : "";
    violations.push_back(c.name + " = " + shortest(outside.value) + " is outside of its bounds, " +
                         boundsText(c) + ": " + when +
                         (outside.t > 0 && outside.t < 1 ? "after " : "in ") + "line " +
                         std::to_string(line) +
                         (outside.t > 0 && outside.t < 1 ? "" : degreesHintOf(c, outside.value)));
  }
}

/// Returns half the diagonal of the shape's bounding box, plus the largest radius of its parts.
double sizeOf(const VerifyBody& body) {
  Vec3 lower = Vec3::Constant(HUGE_VAL), upper = -lower;
  double radius = 0;
  const auto include = [&](const std::vector<Vec3>& points) {
    for (const Vec3& p : points) {
      lower = lower.cwiseMin(p);
      upper = upper.cwiseMax(p);
    }
  };
  if (body.mesh) include(body.mesh->vertices);
  for (const ConvexPart& part : body.parts) {
    include(part.points);
    radius = std::max(radius, part.radius);
  }
  return 0.5 * (upper - lower).norm() + radius;
}

/// Returns a tenth of the checker's tolerance, so that the verifier can decide paths that the
/// checker certified. If the checker's tolerance is unset, returns a tenth of `defaultTolerance`
/// for the smallest tested shape, or for a shape of 1 m if all are larger.
double toleranceOf(const Model& model, const Required& need, const PathProblem& plain,
                   const std::optional<double>& checkerTolerance) {
  // The verifier needs a positive tolerance.
  const auto tenth = [](double tolerance) {
    return std::max(0.1 * tolerance, std::numeric_limits<double>::min());
  };
  if (checkerTolerance) return tenth(*checkerTolerance);
  double smallest = 1;
  for (const VerifyPair& pair : plain.pairs)
    for (const std::size_t body : {pair.a, pair.b})
      if (const double size = sizeOf(plain.bodies[body]); size > 0)
        smallest = std::min(smallest, size);
  return tenth(defaultTolerance(model, need, 1e-7 * smallest));
}

DigestState digestState(const Problem& problem, const Solution& solution) {
  if (solution.digest.empty()) return DigestState::none;
  return solution.digest == digestOf(problem) ? DigestState::same : DigestState::differs;
}

}  // namespace

std::string firstFinding(const VerifyReport& report) {
  if (!report.violations.empty()) return report.violations.front();
  if (report.pathReport.findings.empty()) return "";
  const PathFinding& f = report.pathReport.findings.front();
  std::string place = f.inEveryState
                          ? "in every state"
                          : "edge " + std::to_string(f.edge) + " at t = " + shortest(f.t);
  if (const auto k = static_cast<std::size_t>(f.edge);
      k + 1 < report.times.size() && !f.inEveryState)
    place =
        "at " + shortest(report.times[k] + f.t * (report.times[k + 1] - report.times[k])) + " s";
  return place + ": " + f.reason + (f.a.empty() ? "" : ": " + f.a + " and " + f.b) +
         (f.gap > 0 ? ", " + shortest(f.gap) + " m apart" : "");
}

PathProblem plainProblem(const Model& model, const Task& task,
                         const std::optional<double>& tolerance) {
  requireObstaclesAtRest(model);
  PathProblem plain;
  plain.tree = &model.tree;
  plain.space = &model.space;
  plain.margin = task.margin;
  plain.tube = task.tube;
  std::vector<std::vector<std::size_t>> parts;  // for each body, the indices of its shapes
  for (const ModelBody& body : model.bodies) {
    parts.emplace_back();
    for (const PlacedShape& shape : body.shapes) {
      parts.back().push_back(plain.bodies.size());
      plain.bodies.push_back({body.name, shape.mesh ? &shape.mesh->mesh : nullptr, shape.parts,
                              shape.solid, body.frame});
    }
  }
  const Required need = requiredBy(task);
  forEachPair(model, need, [&](std::size_t i, std::size_t j, std::string_view why) {
    if (!why.empty() && why != kTestedAtRest) return;
    std::vector<VerifyPair>& pairs = why.empty() ? plain.pairs : plain.heldPairs;
    for (const std::size_t a : parts[i])
      for (const std::size_t b : parts[j])
        pairs.push_back({a, b, paddingOf(model, task.padding, i, j)});
  });
  if (const auto proved = provedBox(model, need)) {
    plain.provedLower = proved->lower;
    plain.provedUpper = proved->upper;
  }
  plain.tolerance = toleranceOf(model, need, plain, tolerance);
  return plain;
}

PathProblem plainProblem(const Problem& problem) {
  return plainProblem(problem.model, problem.task, problem.settings.checker.tolerance);
}

const char* nameOf(DigestState state) {
  return state == DigestState::same ? "same" : state == DigestState::differs ? "differs" : "none";
}

const char* nameOf(PathVerdict verdict) {
  return verdict == PathVerdict::proved    ? "proved"
         : verdict == PathVerdict::refuted ? "refuted"
                                           : "undecided";
}

const char* verdictName(const VerifyReport& report) {
  return report.otherProblem ? "other problem" : nameOf(report.verdict);
}

namespace {

/// Tries to prove a clearance as a margin, if the bound that the report has falls short of it.
/// Refining a bound is another method than proving a margin, and ends earlier.
/// @param verify verifies the path or curve of the report.
void proveClaim(PathProblem plain, double claim,
                const std::function<PathReport(const PathProblem&)>& verify, PathReport& report) {
  if (report.verdict != PathVerdict::proved || !(claim > report.provedClearance) ||
      !(claim < report.closestFound))
    return;
  plain.margin = claim;
  plain.heldPairs.clear();
  for (VerifyPair& pair : plain.pairs) pair.padding = 0;
  const PathReport claimed = verify(plain);
  report.distanceQueries += claimed.distanceQueries;
  if (claimed.verdict == PathVerdict::proved) report.provedClearance = claimed.provedClearance;
  report.closestFound = std::min(report.closestFound, claimed.closestFound);
}

}  // namespace

VerifyReport verifySolution(const Problem& problem, const Solution& solution,
                            DigestMismatch other) {
  VerifyReport report;
  report.margin = problem.task.margin;
  report.tube = problem.task.tube;
  report.digest = digestState(problem, solution);
  report.otherProblem = report.digest == DigestState::differs && other == DigestMismatch::refused;
  if (report.otherProblem) {
    report.verdict = report.pathReport.verdict = PathVerdict::undecided;
    report.pathReport.edges = static_cast<int>(solution.path.size()) - 1;
    std::vector<std::string> unused;
    report.reachesGoal = checkEnds(problem, solution.path, unused);  // pictures show this
    return report;
  }
  report.reachesGoal = checkEnds(problem, solution.path, report.violations);
  checkBounds(problem, solution.path, report.violations);
  PathProblem plain = plainProblem(problem);
  plain.wantedClearance = solution.clearance;
  // A path of many states, such as samples of a trajectory, needs some hundred queries for each
  // edge.
  plain.workLimit = std::max<std::uint64_t>(plain.workLimit, 2000 * solution.path.size());
  report.pathReport = verifyPath(plain, solution.path);
  const auto again = [&](const PathProblem& with) { return verifyPath(with, solution.path); };
  proveClaim(std::move(plain), solution.clearance, again, report.pathReport);
  report.verdict = report.violations.empty() ? report.pathReport.verdict : PathVerdict::refuted;
  return report;
}

VerifyReport verifyTrajectory(const Problem& problem, TrajectoryRows rows,
                              std::optional<RowInterpolation> between) {
  VerifyReport report;
  report.margin = problem.task.margin;
  report.tube = problem.task.tube;
  report.between = interpolationOf(rows, between);
  const ConfigurationSpace& space = problem.model.space;
  const Curve curve = curveOf(rows, space, *report.between);
  if (rows.timed) {
    report.times = curve.knots;
    report.limits =
        limitsOfRows(rows, *report.between, space, problem.task.limits, problem.model.tree);
  }
  report.notes = std::move(rows.notes);
  const auto note = [&](const std::string& what, const std::string& away) {
    if (!away.empty()) report.notes.push_back({what + away, NoteWeight::coverage});
  };
  note("the trajectory does not begin at the problem's start: ",
       notStart(problem, rows.rows.front().positions));
  const std::string fromGoal = notInGoal(problem, rows.rows.back().positions);
  report.reachesGoal = fromGoal.empty();
  note("the trajectory does not end in the problem's goal: ", fromGoal);
  checkBounds(space, rows, curve, report.violations);
  PathProblem plain = plainProblem(problem);
  // A curve of many pieces needs some hundred queries for each piece.
  plain.workLimit = std::max<std::uint64_t>(plain.workLimit, 2000 * curve.knots.size());
  // A curve outside the bounds is refuted already, and may be of any length, for instance if its
  // times have a wrong unit. So only contacts that are found quickly are reported, too.
  if (!report.violations.empty()) plain.workLimit = 10'000;
  // A file of rows claims no clearance. The preferred one is what the trajectory should have. Where
  // it comes closer, the bound is refined nearly up to the closest distance found. So it reaches
  // what `solve` reports.
  plain.wantedClearance = preferredClearance(problem);
  report.pathReport = verifyCurve(plain, curve.pieces);
  const auto again = [&](const PathProblem& with) { return verifyCurve(with, curve.pieces); };
  const double wanted = plain.wantedClearance;
  proveClaim(std::move(plain), wanted, again, report.pathReport);
  report.verdict = report.violations.empty() ? report.pathReport.verdict : PathVerdict::refuted;
  return report;
}

}  // namespace corridor
