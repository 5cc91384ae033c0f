#pragma once

#include "planner/robot/configuration_space.h"

namespace corridor {

/// Return the difference of two poses of a planar or floating joint, without weights:
/// `positionDifference` |Δp| in metres, `rotationDifference` the angle of the rotation from one
/// pose to the other, radians in [0, π].
double positionDifference(const ConfigurationSpace& space, const CoordinateGroup& group,
                          const Configuration& a, const Configuration& b);
double rotationDifference(const ConfigurationSpace& space, const CoordinateGroup& group,
                          const Configuration& a, const Configuration& b);

}  // namespace corridor
