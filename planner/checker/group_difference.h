#pragma once

#include "planner/robot/configuration_space.h"

namespace corridor {

/// Differences of two poses of a planar or floating joint, without weights: |Δp| in metres, and the
/// angle of the rotation from one to the other, radians in [0, π].
double positionDifference(const ConfigurationSpace& space, const CoordinateGroup& group,
                          const Configuration& a, const Configuration& b);
double rotationDifference(const ConfigurationSpace& space, const CoordinateGroup& group,
                          const Configuration& a, const Configuration& b);

}  // namespace corridor
