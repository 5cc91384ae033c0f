#include "planner/solve/make_trajectory.h"

#include <algorithm>
#include <cmath>

#include "planner/solve/smooth_path.h"
#include "planner/trajectory/emit.h"
#include "planner/trajectory/time_law.h"
#include "planner/trajectory/trajectory_text.h"

namespace corridor {
namespace {

/// The times of a message are whole nanoseconds. Rounding the ends of an interval of 1 ms changes a
/// velocity by 10^-6 of itself, and an acceleration by twice this share. So the law of a message
/// gets this much less of each limit.
constexpr double kShareForRounding = 1e-5;
constexpr int kTries = 4;

/// Returns the limits of each number by itself. A planar or floating joint has its limits at its
/// first number, x.
Configuration eachNumber(const ConfigurationSpace& space, Configuration limits) {
  for (const CoordinateGroup& group : space.groups()) {
    if (group.kind == CoordinateGroup::Kind::joints) continue;
    const auto first = static_cast<Eigen::Index>(space.coordinates()[group.coordinates[0]].first);
    for (const std::size_t c : group.coordinates) {
      const Coordinate& coordinate = space.coordinates()[c];
      if (coordinate.kind == Coordinate::Kind::line)
        limits[static_cast<Eigen::Index>(coordinate.first)] = limits[first];
    }
  }
  return limits;
}

SmoothOptions smoothOptions(const ConfigurationSpace& space, const JointLimits& limits,
                            const TrajectoryOptions& options) {
  SmoothOptions smooth;
  if (options.cornerDeviation) smooth.deviation = *options.cornerDeviation;
  smooth.acceleration = eachNumber(space, limits.acceleration);
  smooth.velocity = eachNumber(space, limits.velocity);
  // Without a limit, the velocity that is reached after 1 s stands for it. It only weighs numbers.
  for (Eigen::Index i = 0; i < smooth.velocity.size(); ++i)
    if (!std::isfinite(smooth.velocity[i])) smooth.velocity[i] = smooth.acceleration[i];
  return smooth;
}

JointLimits reduced(JointLimits limits, double factor) {
  limits.velocity *= factor;
  limits.acceleration *= factor;
  limits.jerk *= factor;
  for (LinkSpeed& link : limits.links) link.speed *= factor;
  return limits;
}

std::string textOf(const std::vector<TimedRow>& timed, const ConfigurationSpace& space,
                   Between between, TrajectoryFileKind kind) {
  TrajectoryRows rows;
  rows.timed = true;
  rows.hasVelocities = between != Between::linear;
  rows.hasAccelerations = between == Between::quintic;
  for (const TimedRow& row : timed) {
    const double time =
        kind == TrajectoryFileKind::message ? nearestNanosecond(row.time) : row.time;
    rows.rows.push_back({0, time, row.position, row.velocity, row.acceleration});
  }
  return kind == TrajectoryFileKind::csv ? csvText(rows, space) : messageText(rows, space);
}

/// Proves the pieces of a curve in order, up to the first one that can't be proved.
void prove(const Checker& checker, MadeTrajectory& made) {
  made.proof = {};
  for (std::size_t k = 0; k < made.curve.pieces.size(); ++k) {
    made.proof = checker.certifyCurve(made.curve.pieces[k]);
    made.failedPiece = k;
    if (made.proof.verdict != MotionVerdict::free) return;
  }
}

}  // namespace

bool MadeTrajectory::keepsLimits() const {
  return std::max({ratios.velocity.share, ratios.acceleration.share, ratios.jerk.share,
                   ratios.link.share}) <= 1 &&
         ratios.position.share <= 0;
}

MadeTrajectory makeTrajectory(const Problem& problem, const Checker& checker, const Path& path,
                              const TrajectoryOptions& options, const std::function<bool()>& stop) {
  const ConfigurationSpace& space = problem.model.space;
  const JointLimits& limits = problem.task.limits;
  MadeTrajectory made;
  const auto isFree = [&](const CurvePiece& piece) {
    return checker.certifyCurve(piece).verdict == MotionVerdict::free;
  };
  const SmoothPath smooth =
      smoothedPath(space, path, isFree, smoothOptions(space, limits, options), stop);
  made.corners = smooth.corners;
  made.rounded = smooth.rounded;
  made.curveTests = smooth.tests;

  const bool limitsJerk = limits.jerk.array().isFinite().any();
  made.between = limitsJerk ? Between::quintic : Between::cubic;
  const bool rounds = options.kind == TrajectoryFileKind::message;
  const JointLimits kept = rounds ? reduced(limits, 1 - kShareForRounding) : limits;
  TimeLawOptions lawOptions;
  lawOptions.smooth = limitsJerk;
  const TimeLaw law = timeLaw(smooth.pieces, space, kept, problem.model.tree, lawOptions);
  made.fault = law.fault;
  EmitOptions emit;
  emit.degree = limitsJerk ? 5 : 3;
  emit.rate = options.rate;
  emit.deviation = options.deviation;
  for (int i = 0; i < kTries && made.fault.empty(); ++i, emit.deviation /= 4) {
    const Emission emission = emitRows(law, smooth.pieces, space, kept, problem.model.tree, emit);
    made.fault = emission.fault;
    if (!made.fault.empty()) break;
    made.duration = emission.duration;
    made.stretch = emission.stretch;
    made.text = textOf(emission.rows, space, made.between, options.kind);
    const TrajectoryRows read = readTrajectory("the trajectory", made.text, problem.model);
    made.rows = read.rows.size();
    made.curve = curveOf(read, space, made.between);
    std::vector<TimedRow> rows;
    for (const TrajectoryRow& row : read.rows)
      rows.push_back({row.time, row.positions, row.velocities, row.accelerations});
    made.ratios = proveLimits(rows, emit.degree, space, limits, problem.model.tree);
    prove(checker, made);
    if (made.proved()) break;
  }
  if (!made.fault.empty()) made.text.clear();
  return made;
}

}  // namespace corridor
