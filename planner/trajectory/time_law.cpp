#include "planner/trajectory/time_law.h"

#include <algorithm>
#include <cmath>

#include "collision/core/shortest.h"
#include "planner/trajectory/run_law.h"
#include "planner/trajectory/smooth_law.h"

namespace corridor {
namespace {

std::string nameOf(const ConfigurationSpace& space, Eigen::Index number) {
  return space.numberNames()[static_cast<std::size_t>(number)];
}

/// Returns why a path or its limits can't be used, or "".
std::string checked(const PathView& view, const JointLimits& limits) {
  const ConfigurationSpace& space = view.space();
  const auto size = static_cast<Eigen::Index>(space.size());
  for (std::size_t k = 0; k < view.path().size(); ++k) {
    const Eigen::MatrixXd& c = view.path()[k].coefficients;
    if (c.rows() != size || c.cols() < 2 || c.cols() > CurvePiece::kLargestDegree + 1)
      return "piece " + std::to_string(k) + " has " + std::to_string(c.rows()) + " rows and " +
             std::to_string(c.cols()) + " columns; " + std::to_string(size) +
             " rows and 2 to 10 columns are needed";
    if (!c.allFinite()) return "piece " + std::to_string(k) + " has a number that is not finite";
  }
  for (const Configuration* values : {&limits.velocity, &limits.acceleration, &limits.jerk})
    if (values->size() != size || values->array().isNaN().any())
      return "the limits must have " + std::to_string(size) + " numbers each, and no NaN";
  return "";
}

/// Returns why a path can't be passed through: a component moves although its limit is not
/// positive, or the speed limit of a link is not positive. Returns "" if neither is the case.
std::string whyStuck(const PathView& view, const JointLimits& limits) {
  Configuration moves = Configuration::Zero(static_cast<Eigen::Index>(view.space().size()));
  for (std::size_t k = 0; k < view.path().size(); ++k) {
    const Eigen::MatrixXd& c = view.path()[k].coefficients;
    Configuration extent = c.rowwise().maxCoeff() - c.rowwise().minCoeff();
    for (std::size_t r = 0; r < view.rotations().size(); ++r)
      extent.segment<4>(view.rotations()[r]) << view.turn(k, r).norm(), 0, 0, 0;
    moves = moves.cwiseMax(extent);
  }
  for (const PositionGroup& group : positionGroups(view.space())) {
    const double most = moves.segment(group.first, group.count).maxCoeff();
    moves.segment(group.first, group.count).setZero();
    moves[group.first] = most;
  }
  const auto complain = [&](const char* what, const Configuration& limit) -> std::string {
    for (Eigen::Index i = 0; i < moves.size(); ++i)
      if (moves[i] > 0 && !(limit[i] > 0))
        return nameOf(view.space(), i) + " moves, but its limit of " + what + " is " +
               shortest(limit[i]) + "; a positive one is needed";
    return "";
  };
  if (std::string why = complain("velocity", limits.velocity); !why.empty()) return why;
  if (std::string why = complain("acceleration", limits.acceleration); !why.empty()) return why;
  if (std::string why = complain("jerk", limits.jerk); !why.empty()) return why;
  for (const LinkSpeed& link : limits.links)
    if (!(link.speed > 0))
      return "the speed limit of link " + link.link + " is " + shortest(link.speed) +
             "; a positive one is needed";
  return "";
}

/// Returns the message for a failure of reachability analysis. @param rate the given dτ/dt at the
/// start or end of the path. @param length ds/dτ at the same place.
std::string faultOf(const RunLaw& law, double rate, double length) {
  const std::string place =
      "piece " + std::to_string(law.piece) + ", τ = " + shortest(law.tau) + ": ";
  const std::string range =
      law.lower > 0 ? "from " + shortest(law.lower / length) + " to " + shortest(law.upper / length)
                    : "at most " + shortest(law.upper / length);
  switch (law.failure) {
    case Profile::Failure::start:
      return place + "no law starts with the rate " + shortest(rate) +
             " per second within the limits; " + range + " is possible";
    case Profile::Failure::end:
      if (law.tau == 1)
        return place + "no law ends with the rate " + shortest(rate) +
               " per second within the limits; " + range + " is possible";
      return place + "the rate " + shortest(rate) +
             " per second at the end can't be reached within the limits; use a smaller rate";
    default:
      return place + "the limits allow no motion here";
  }
}

/// Sets `law.use`. The middle of each segment stands for the whole segment.
void setUse(const PathView& view, const JointLimits& limits, TimeLaw& law) {
  law.use.assign(view.space().size(), {});
  Configuration first, second;
  for (const LawSegment& segment : law.segments) {
    const double d = segment.duration / 2;
    const double rate = segment.rate + d * (segment.acceleration + d / 2 * segment.jerk);
    const double tau =
        segment.tau + d * (segment.rate + d / 2 * (segment.acceleration + d / 3 * segment.jerk));
    view.derivatives(segment.piece, std::min(1.0, tau), first, second);
    const double acceleration = segment.acceleration + d * segment.jerk;
    const Configuration velocities = sharesOf(first * rate, limits.velocity, view.space());
    const Configuration accelerations =
        sharesOf(second * (rate * rate) + first * acceleration, limits.acceleration, view.space());
    for (std::size_t i = 0; i < law.use.size(); ++i) {
      const auto n = static_cast<Eigen::Index>(i);
      if (velocities[n] >= 0.99) law.use[i].velocity += segment.duration / law.duration;
      if (accelerations[n] >= 0.99) law.use[i].acceleration += segment.duration / law.duration;
    }
  }
}

}  // namespace

TimeLaw timeLaw(const std::vector<CurvePiece>& path, const ConfigurationSpace& space,
                const JointLimits& limits, const KinematicTree& tree,
                const TimeLawOptions& options) {
  TimeLaw law;
  law.options = options;
  const auto fail = [&](const std::string& why) {
    law.segments.clear();
    law.stopTimes.clear();
    law.duration = 0;
    law.fault = "time law: " + why;
    return law;
  };
  for (const double rate : {options.startRate, options.endRate})
    if (!(rate >= 0 && std::isfinite(rate)))
      return fail("the rates at start and end must be finite, and 0 or more");
  if (options.smooth && (options.startRate > 0 || options.endRate > 0))
    return fail("a smooth law starts and ends at rest; leave the rates at 0");
  // A PathView reads the first and the last coefficients of each piece, so sizes are checked first.
  for (const CurvePiece& piece : path)
    if (piece.coefficients.cols() < 2 ||
        piece.coefficients.rows() != static_cast<Eigen::Index>(space.size()))
      return fail("a piece has a wrong number of rows or columns");
  const PathView view(path, space);
  if (const std::string why = checked(view, limits); !why.empty()) return fail(why);
  if (const std::string why = whyStuck(view, limits); !why.empty()) return fail(why);
  const bool jerkLimited = options.smooth && limits.jerk.array().isFinite().any();
  const std::vector<PathRun> runs = runsOf(view, options.cornerAngle, jerkLimited);
  const LimitBands bands(view, limits, tree);
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const PathRun& run = runs[k];
    const bool isFirst = k == 0, isLast = k + 1 == runs.size();
    const double startLength = run.parts.front().length, endLength = run.parts.back().length;
    // Returns ds/dt at an end of a run; infinity: any. Where the tangent is 0 (`isFree`), the robot
    // is at rest at any rate.
    const auto rateOf = [&](bool isEnd, double rate, double length, bool isFree) {
      if (isEnd && rate > 0) return rate * length;
      return isFree && !options.smooth ? INFINITY : 0.0;
    };
    const double start = rateOf(isFirst, options.startRate, startLength, run.restsAtStart);
    const double end = rateOf(isLast, options.endRate, endLength, run.restsAtEnd);
    RunLaw part = fastestLaw(view, run, bands, start, end, options.intervals);
    if (part.failure != Profile::Failure::none)
      return fail(faultOf(
          part, part.failure == Profile::Failure::start ? options.startRate : options.endRate,
          part.failure == Profile::Failure::start ? startLength : endLength));
    const bool moves = !part.segments.empty();
    if (options.smooth) part.segments = smoothLaw(view, run, limits, tree, part.segments);
    if (moves && part.segments.empty())
      return fail("the limits are too large or too small for doubles, or there are none");
    if (!isFirst) law.stopTimes.push_back(law.duration);
    const double begin = law.duration;
    for (LawSegment& segment : part.segments) {
      segment.time += begin;
      law.segments.push_back(segment);
    }
    law.duration = law.segments.back().time + law.segments.back().duration;
  }
  if (!std::isfinite(law.duration) || (!law.segments.empty() && !(law.duration > 0)))
    return fail("the limits are too large or too small for doubles, or there are none");
  setUse(view, limits, law);
  return law;
}

}  // namespace corridor
