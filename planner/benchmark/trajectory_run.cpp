#include "planner/benchmark/trajectory_run.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/core/shortest.h"
#include "planner/solve/solve_run.h"
#include "planner/solve/verify_solution.h"
#include "planner/trajectory/curve_pieces.h"
#include "planner/trajectory/natural_spline.h"
#include "planner/trajectory/time_law.h"
#include "planner/trajectory/trajectory_file.h"
#include "planner/trajectory/trajectory_text.h"

namespace corridor {
namespace {

/// Radians. The time law stops at corners whose angle is larger than this value. No angle is larger
/// than π, so the time law never stops.
constexpr double kEveryCorner = 4;

MadeTrajectory noTrajectory(std::string why) {
  MadeTrajectory none;
  none.fault = std::move(why);
  return none;
}

MadeTrajectory makeSpline(bool inserts, const Problem& problem, const Checker& checker,
                          const std::vector<CurvePiece>& lines) {
  const ConfigurationSpace& space = problem.model.space;
  if (hasRotation(space))
    return noTrajectory(
        "splines of quaternions are not rotations, so there is no spline for a body that rotates "
        "freely");
  const std::vector<Configuration> states = statesOfLines(lines);
  const auto touches = [&](const Configuration& q) { return checker.interference(q).has_value(); };
  const std::vector<CurvePiece> pieces =
      inserts ? insertedSpline(space, states, touches).pieces : naturalSpline(states);
  return trajectoryAlong(problem, checker, pieces, {}, 1);
}

/// Returns a share, or −1 if there is no such limit, or the rows don't determine the limited
/// quantity. An infinite share becomes the largest double, because JSON has no infinity.
double shareOf(const LimitShare& share, bool limited) {
  if (!limited || !share.tested) return -1;
  return std::min(share.share, std::numeric_limits<double>::max());
}

}  // namespace

const std::vector<std::string>& trajectoryMakerNames() {
  static const std::vector<std::string> names{"blends", "stop", "spline", "inserted"};
  return names;
}

const char* nameOf(TrajectoryMaker maker) {
  return trajectoryMakerNames()[static_cast<std::size_t>(maker)].c_str();
}

std::optional<TrajectoryMaker> trajectoryMakerNamed(const std::string& name) {
  const auto& names = trajectoryMakerNames();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<TrajectoryMaker>(found - names.begin());
}

MadeTrajectory makeBy(TrajectoryMaker maker, const Problem& problem, const Checker& checker,
                      const Path& path) {
  std::vector<CurvePiece> lines;
  if (path.size() > 1) lines = curveOfPath(problem.model.space, path).pieces;
  if (statesOfLines(lines).size() < 2) return noTrajectory("the path does not move");
  if (maker == TrajectoryMaker::blends) return makeTrajectory(problem, checker, path);
  if (maker == TrajectoryMaker::stop) return trajectoryAlong(problem, checker, lines);
  return makeSpline(maker == TrajectoryMaker::inserted, problem, checker, lines);
}

double optimumAlong(const Problem& problem, const Path& path) {
  if (path.size() < 2) return std::numeric_limits<double>::quiet_NaN();
  TimeLawOptions options;
  options.cornerAngle = kEveryCorner;
  const TimeLaw law = timeLaw(curveOfPath(problem.model.space, path).pieces, problem.model.space,
                              problem.task.limits, problem.model.tree, options);
  return law.fault.empty() && law.duration > 0 ? law.duration
                                               : std::numeric_limits<double>::quiet_NaN();
}

TrajectoryRun runTrajectory(TrajectoryMaker maker, const Problem& problem, const Checker& checker,
                            const Path& path) {
  TrajectoryRun run;
  const SolveClock making;
  const MadeTrajectory made = makeBy(maker, problem, checker, path);
  run.makeTime = making.seconds();
  run.fault = made.fault;
  if (!run.fault.empty()) return run;
  run.duration = made.duration;
  run.rows = made.rows;
  const JointLimits& limits = problem.task.limits;
  const auto given = [](const Configuration& of) { return of.array().isFinite().any(); };
  run.velocity = shareOf(made.ratios.velocity, given(limits.velocity));
  run.acceleration = shareOf(made.ratios.acceleration, given(limits.acceleration));
  run.jerk = shareOf(made.ratios.jerk, given(limits.jerk));
  run.link = shareOf(made.ratios.link, !limits.links.empty());
  run.beyondBounds = made.ratios.position.share;
  const SolveClock verifying;
  const VerifyReport report = verifyTrajectory(
      problem, readTrajectory("the trajectory", made.text, problem.model), made.between);
  run.verifyTime = verifying.seconds();
  run.verdict = verdictName(report);
  if (report.verdict != PathVerdict::proved) run.finding = firstFinding(report);
  return run;
}

}  // namespace corridor
