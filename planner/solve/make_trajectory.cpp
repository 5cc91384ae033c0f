#include "planner/solve/make_trajectory.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "planner/solve/shorten_curve.h"
#include "planner/solve/smooth_path.h"
#include "planner/trajectory/emit.h"
#include "planner/trajectory/limit_bands.h"
#include "planner/trajectory/time_law.h"
#include "planner/trajectory/trajectory_text.h"

namespace corridor {
namespace {

/// Returns a limit for each number. In `limits`, the limit for the position of a planar or floating
/// joint is stored only at the joint's first number, x.
Configuration eachNumber(const ConfigurationSpace& space, Configuration limits) {
  for (const PositionGroup& group : positionGroups(space))
    limits.segment(group.first, group.count).setConstant(limits[group.first]);
  return limits;
}

SmoothOptions smoothOptions(const ConfigurationSpace& space, const JointLimits& limits,
                            const TrajectorySettings& settings) {
  SmoothOptions smooth;
  smooth.goal = settings.smooth;
  if (settings.cornerDeviation) smooth.deviation = *settings.cornerDeviation;
  smooth.acceleration = eachNumber(space, limits.acceleration);
  smooth.velocity = eachNumber(space, limits.velocity);
  return smooth;
}

JointLimits reduced(JointLimits limits, double factor) {
  limits.velocity *= factor;
  limits.acceleration *= factor;
  limits.jerk *= factor;
  for (LinkSpeed& link : limits.links) link.speed *= factor;
  return limits;
}

std::string textOf(const std::vector<TimedRow>& timed, const Model& model, RowInterpolation between,
                   TrajectoryFileKind kind) {
  TrajectoryRows rows;
  rows.timed = true;
  rows.hasVelocities = between != RowInterpolation::linear;
  rows.hasAccelerations = between == RowInterpolation::quintic;
  for (const TimedRow& row : timed) {
    // The times of a message are whole nanoseconds. The position is that at the rounded time, up to
    // 10^-18 s² times the acceleration. With the position at the unrounded time, the acceleration
    // between two rows that are near each other would change.
    const double time =
        kind == TrajectoryFileKind::message ? nearestNanosecond(row.time) : row.time;
    const Configuration position = row.position + (time - row.time) * row.velocity;
    rows.rows.push_back(
        {0, time, time == row.time ? row.position : position, row.velocity, row.acceleration});
  }
  return kind == TrajectoryFileKind::csv ? csvText(rows, model) : messageText(rows, model.space);
}

bool limitsJerk(const JointLimits& limits) {
  return limits.jerk.array().isFinite().any();
}

TimeLaw lawOf(const Problem& problem, const std::vector<CurvePiece>& path,
              const JointLimits& limits) {
  TimeLawOptions options;
  options.smooth = limitsJerk(limits);
  return timeLaw(path, problem.model.space, limits, problem.model.tree, options);
}

/// A curve, and the time law along this curve within the problem's limits.
struct LawfulCurve {
  std::vector<CurvePiece> pieces;
  TimeLaw law;
};

LawfulCurve withLaw(const Problem& problem, std::vector<CurvePiece> pieces) {
  TimeLaw law = lawOf(problem, pieces, problem.task.limits);
  return {std::move(pieces), std::move(law)};
}

/// What the curve of a trajectory must keep.
struct Wanted {
  const CurveClearance* clearance = nullptr;  // null: it must be free
  std::vector<double> fractions = {};         // of the targets, which each edge of the path keeps
  bool everywhere() const {
    return std::ranges::all_of(fractions, [](double each) { return each == 1; });
  }
};

Wanted wantedOn(const Path& path, const CurveClearance* clearance) {
  Wanted wanted{clearance};
  for (std::size_t i = 0; clearance && i + 1 < path.size(); ++i)
    wanted.fractions.push_back(clearance->fractionKept(path[i], path[i + 1]));
  return wanted;
}

/// Makes the curve that the trajectory passes along, and counts its corners and tests.
/// @param refuses is set if a free piece was refused because it misses clearance targets
LawfulCurve smoothCurve(const Problem& problem, const Checker& checker, const Path& path,
                        const Wanted& wanted, const std::function<bool()>& stop,
                        MadeTrajectory& made, bool& refuses) {
  const ConfigurationSpace& space = problem.model.space;
  SmoothOptions options = smoothOptions(space, problem.task.limits, problem.settings.trajectory);
  options.fractions = wanted.fractions;
  const CurveTest isFree = [&](const CurvePiece& piece, double fraction) {
    const auto free = [&] { return checker.certifyCurve(piece).verdict == MotionVerdict::free; };
    if (!wanted.clearance) return free();
    if (wanted.clearance->isKept(piece, fraction)) return true;
    refuses = refuses || free();
    return false;
  };
  SmoothPath smooth = smoothedPath(space, path, isFree, options, stop);
  made.corners = smooth.corners;
  made.rounded = smooth.rounded;
  made.curveTests = smooth.tests;
  if (options.goal == Smoothing::none || options.goal == Smoothing::corners ||
      std::isfinite(options.deviation))
    return withLaw(problem, std::move(smooth.pieces));
  options.fractions = std::move(smooth.fractions);
  ShortCurve curve = shortenedCurve(space, smooth.pieces, isFree, options, stop);
  made.curveTests += curve.tests;
  LawfulCurve whole = withLaw(problem, std::move(curve.pieces));
  // Smoothing reduced an estimate of the time only, so the durations of the two time laws are
  // compared.
  if (options.goal == Smoothing::time && curve.replaced > 0) {
    LawfulCurve corners = withLaw(problem, std::move(smooth.pieces));
    const bool isFaster = !corners.law.fault.empty() || whole.law.duration < corners.law.duration;
    if (!whole.law.fault.empty() || !isFaster) return corners;
  }
  made.replaced = curve.replaced;
  return whole;
}

/// Proves the pieces of a curve in order, up to the first one that can't be proved.
void prove(const Checker& checker, const Wanted& wanted, MadeTrajectory& made) {
  made.proof = {};
  made.clearance.reset();
  made.losesClearance = false;
  const std::vector<CurvePiece>& pieces = made.curve.pieces;
  std::vector<char> kept(pieces.size(), 0);
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    if (wanted.clearance && wanted.clearance->keepsTargets(pieces[k])) {
      kept[k] = 1;
      continue;
    }
    made.proof = checker.certifyCurve(pieces[k]);
    made.failedPiece = k;
    if (made.proof.verdict != MotionVerdict::free) return;
  }
  made.proof.verdict = MotionVerdict::free;
  if (!wanted.clearance) return;
  made.clearance = wanted.clearance->prove(made.curve, kept);
  made.losesClearance =
      made.clearance->isLess || (made.clearance->shareOnTarget < 1 && wanted.everywhere());
}

/// Makes the text of rows, and proves the curve that the text describes.
void proveText(const Problem& problem, const Checker& checker, const Wanted& wanted,
               const std::vector<TimedRow>& rows, TrajectoryFileKind kind, MadeTrajectory& made) {
  const ConfigurationSpace& space = problem.model.space;
  try {
    made.text = textOf(rows, problem.model, made.between, kind);
    const TrajectoryRows read = readTrajectory("the trajectory", made.text, problem.model);
    made.rows = read.rows.size();
    made.duration = read.rows.back().time - read.rows.front().time;
    made.curve = curveOf(read, space, made.between);
    made.ratios = limitsOfRows(read, made.between, space, problem.task.limits, problem.model.tree);
  } catch (const InputError& error) {  // rows of a message that are less than 1 ns apart
    made.fault = error.what();
    return;
  } catch (const std::invalid_argument& error) {  // names of joints
    made.fault = error.what();
    return;
  }
  prove(checker, wanted, made);
}

/// Makes the rows along a curve and their text, and proves the curve that the text describes.
/// `limits` are those of the time law.
void makeText(const Problem& problem, const Checker& checker, const Wanted& wanted,
              const LawfulCurve& curve, const JointLimits& limits, TrajectoryFileKind kind,
              double deviation, MadeTrajectory& made) {
  const ConfigurationSpace& space = problem.model.space;
  const KinematicTree& tree = problem.model.tree;
  made.fault = curve.law.fault;
  if (!made.fault.empty()) return;
  EmitOptions emit;
  emit.degree = made.between == RowInterpolation::quintic ? 5 : 3;
  emit.rate = problem.settings.trajectory.rate;
  emit.deviation = deviation;
  const Emission emission = emitRows(curve.law, curve.pieces, space, limits, tree, emit);
  made.fault = emission.fault;
  if (!made.fault.empty()) return;
  made.stretch = emission.stretch;
  proveText(problem, checker, wanted, emission.rows, kind, made);
}

/// A path of at most this length, rad or m, is one on which nothing moves: no encoder resolves it,
/// and the time law along it has no digits left.
constexpr double kNoLength = 1e-9;

/// Returns whether nothing moves along a path.
bool isStill(const ConfigurationSpace& space, const Path& path) {
  const PathLength length = lengthOf(space, path);
  return std::max(length.metres, length.radians) <= kNoLength;
}

/// Returns the path without the states between its ends that are where the state before is, or the
/// last one. Each such edge would cost a stop.
Path withoutStillEdges(const ConfigurationSpace& space, const Path& path) {
  Path moving{path.front()};
  for (std::size_t i = 1; i + 1 < path.size(); ++i)
    if (!isStill(space, {moving.back(), path[i]})) moving.push_back(path[i]);
  while (moving.size() > 1 && isStill(space, {moving.back(), path.back()})) moving.pop_back();
  moving.push_back(path.back());
  return moving;
}

/// Returns two rows, at rest at the first and at the last state of a path on which nothing moves.
/// The time from one to the other is 1 ms, a controller's period, or longer if limits need it.
MadeTrajectory standing(const Problem& problem, const Checker& checker, const Wanted& wanted,
                        const Path& path, TrajectoryFileKind kind) {
  MadeTrajectory made;
  made.between =
      limitsJerk(problem.task.limits) ? RowInterpolation::quintic : RowInterpolation::cubic;
  const Configuration rest = Configuration::Zero(path.front().size());
  Configuration last = path.back();
  for (const Coordinate& c : problem.model.space.coordinates())  // rows are not taken modulo turns
    if (const auto i = static_cast<Eigen::Index>(c.first); c.kind == Coordinate::Kind::circle)
      last[i] +=
          2 * std::numbers::pi * std::round((path.front()[i] - last[i]) / (2 * std::numbers::pi));
  double seconds = 1e-3;
  for (int attempt = 0; attempt < 30; ++attempt, seconds *= 2) {
    proveText(problem, checker, wanted,
              {{0, path.front(), rest, rest}, {seconds, last, rest, rest}}, kind, made);
    if (made.isGood() || !made.fault.empty()) break;
  }
  return made;
}

/// Makes texts along a curve until one is proved and keeps the limits. Completes and returns
/// `made`.
MadeTrajectory provedAlong(const Problem& problem, const Checker& checker, const Wanted& wanted,
                           LawfulCurve curve, TrajectoryFileKind kind, int attempts,
                           MadeTrajectory made) {
  JointLimits limits = problem.task.limits;
  made.between = limitsJerk(limits) ? RowInterpolation::quintic : RowInterpolation::cubic;
  double deviation = problem.settings.trajectory.deviation, share = 1;
  std::optional<MadeTrajectory> proved;
  for (int i = 0; i < attempts && made.fault.empty(); ++i) {
    makeText(problem, checker, wanted, curve, limits, kind, deviation, made);
    if (made.isGood()) return made;
    if (made.proved() && !(proved && keepsLimits(proved->ratios) && !keepsLimits(made.ratios)))
      proved = made;
    deviation /= 4;
    // If the rows before rounding keep the limits, a message can exceed them only by the rounding
    // of its times.
    if (kind == TrajectoryFileKind::message) {
      share -= i == 0 ? 1e-4 : 0.01;
      limits = reduced(problem.task.limits, share);
      if (i + 1 < attempts) curve.law = lawOf(problem, curve.pieces, limits);
    }
  }
  if (proved) return *proved;
  if (!made.fault.empty()) made.text.clear();
  return made;
}

/// Returns a lower bound of the time along lines with a stop at each corner: the duration of the
/// law without limits of jerk and link speed. On lines, this law has a closed form.
double leastTimeWithStops(const Problem& problem, const std::vector<CurvePiece>& lines) {
  JointLimits limits = problem.task.limits;
  limits.jerk.setConstant(HUGE_VAL);
  limits.links.clear();
  const TimeLaw law = timeLaw(lines, problem.model.space, limits, problem.model.tree);
  return law.fault.empty() ? law.duration : 0;
}

/// Steps 1 to 5 of `makeTrajectory`, for a path without still edges.
/// @param refuses as for `smoothCurve`
MadeTrajectory fastestAlong(const Problem& problem, const Checker& checker, const Path& path,
                            const Wanted& wanted, TrajectoryFileKind kind,
                            const std::function<bool()>& stop, bool& refuses) {
  const ConfigurationSpace& space = problem.model.space;
  MadeTrajectory begun;
  LawfulCurve smooth = smoothCurve(problem, checker, path, wanted, stop, begun, refuses);
  MadeTrajectory made =
      provedAlong(problem, checker, wanted, std::move(smooth), kind, kTrajectoryAttempts, begun);
  if (begun.rounded + begun.replaced == 0 || !begun.fault.empty()) return made;

  // Corners that are rounded by little may cost more time than stops.
  std::vector<CurvePiece> lines =
      smoothedPath(space, path, [](const CurvePiece&, double) { return false; }).pieces;
  if (made.isGood() && made.duration <= leastTimeWithStops(problem, lines)) return made;
  begun.rounded = begun.replaced = 0;
  MadeTrajectory stopping =
      provedAlong(problem, checker, wanted, withLaw(problem, std::move(lines)), kind,
                  kTrajectoryAttempts, std::move(begun));
  const bool isBetter = stopping.isGood() ? !made.isGood() || stopping.duration < made.duration
                                          : stopping.proved() && !made.proved();
  if (!isBetter) return made;
  stopping.whyStops = made.isGood()         ? "stops at the corners are faster"
                      : made.losesClearance ? "the rounded path does not keep the clearance"
                      : made.proved()       ? "the trajectory along the rounded path exceeds limits"
                      : made.fault.empty()  ? "the rounded path is not proved"
                                            : "the rounded path has no trajectory: " + made.fault;
  return stopping;
}

}  // namespace

MadeTrajectory makeTrajectory(const Problem& problem, const Checker& checker, const Path& along,
                              TrajectoryFileKind kind, const std::function<bool()>& stop,
                              const CurveClearance* clearance) {
  const Path path = withoutStillEdges(problem.model.space, along);
  const Wanted wanted = wantedOn(path, clearance);
  if (isStill(problem.model.space, path)) return standing(problem, checker, wanted, path, kind);
  bool refuses = false;
  MadeTrajectory made = fastestAlong(problem, checker, path, wanted, kind, stop, refuses);
  if (!made.clearance) return made;
  if (!refuses) {
    made.timeLost = 0;
    return made;
  }
  MadeTrajectory closer;
  const LawfulCurve curve = smoothCurve(problem, checker, path, {}, stop, closer, refuses);
  if (curve.law.fault.empty() && !stop()) made.timeLost = made.duration - curve.law.duration;
  return made;
}

MadeTrajectory trajectoryAlong(const Problem& problem, const Checker& checker,
                               const std::vector<CurvePiece>& curve, TrajectoryFileKind kind,
                               int attempts) {
  return provedAlong(problem, checker, {}, withLaw(problem, curve), kind, attempts, {});
}

}  // namespace corridor
