#include "planner/trajectory/rows_limits.h"

#include <algorithm>

namespace corridor {

LimitRatios limitsOfRows(const TrajectoryRows& rows, Between between,
                         const ConfigurationSpace& space, const JointLimits& limits,
                         const KinematicTree& tree) {
  const Configuration none = Configuration::Zero(static_cast<Eigen::Index>(space.size()));
  std::vector<TimedRow> timed;
  for (const TrajectoryRow& row : rows.rows)
    timed.push_back({row.time, row.positions, rows.hasVelocities ? row.velocities : none,
                     rows.hasAccelerations ? row.accelerations : none});
  const int degree = between == Between::linear ? 1 : between == Between::cubic ? 3 : 5;
  LimitRatios ratios = proveLimits(timed, degree, space, limits, tree);
  if (between == Between::linear) ratios.acceleration = {};
  if (between != Between::quintic) ratios.jerk = {};
  return ratios;
}

bool keepsLimits(const LimitRatios& ratios) {
  return std::max({ratios.velocity.share, ratios.acceleration.share, ratios.jerk.share,
                   ratios.link.share}) <= 1 &&
         ratios.position.share <= 0;
}

}  // namespace corridor
