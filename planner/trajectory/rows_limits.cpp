#include "planner/trajectory/rows_limits.h"

#include <algorithm>
#include <limits>

#include "collision/core/floating_point.h"

namespace corridor {

LimitRatios limitsOfRows(const TrajectoryRows& rows, RowInterpolation between,
                         const ConfigurationSpace& space, const JointLimits& limits,
                         const KinematicTree& tree) {
  const Configuration none = Configuration::Zero(static_cast<Eigen::Index>(space.size()));
  std::vector<TimedRow> timed;
  for (const TrajectoryRow& row : rows.rows)
    timed.push_back({row.time, row.positions, rows.hasVelocities ? row.velocities : none,
                     rows.hasAccelerations ? row.accelerations : none});
  const int degree = between == RowInterpolation::linear  ? 1
                     : between == RowInterpolation::cubic ? 3
                                                          : 5;
  LimitRatios ratios = proveLimits(timed, degree, space, limits, tree);
  const auto leaveOut = [](LimitShare& share, const Configuration& limit) {
    share = {};
    share.tested = !limit.array().isFinite().any();
  };
  if (between == RowInterpolation::linear) leaveOut(ratios.acceleration, limits.acceleration);
  if (between != RowInterpolation::quintic) leaveOut(ratios.jerk, limits.jerk);
  if (standardFloatingPoint()) return ratios;
  for (LimitShare* share : {&ratios.velocity, &ratios.acceleration, &ratios.jerk, &ratios.link})
    if (share->share > 0) share->share = std::numeric_limits<double>::infinity();
  return ratios;
}

bool exceedsLimits(const LimitRatios& ratios) {
  return !(std::max({ratios.velocity.share, ratios.acceleration.share, ratios.jerk.share,
                     ratios.link.share}) <= 1 + kLimitSlack &&
           ratios.position.share <= kLimitSlack);
}

bool keepsLimits(const LimitRatios& ratios) {
  return !exceedsLimits(ratios) && ratios.velocity.tested && ratios.acceleration.tested &&
         ratios.jerk.tested && ratios.link.tested;
}

const char* limitsVerdict(const LimitRatios& ratios) {
  return exceedsLimits(ratios) ? "exceeded" : keepsLimits(ratios) ? "kept" : "not tested";
}

}  // namespace corridor
