#pragma once

#include "planner/robot/configuration_space.h"

namespace corridor {

/// Return, for a planar or floating joint, |Δp| in metres and the angle of its rotation, in [0, π],
/// without weights.
double positionDifference(const ConfigurationSpace& space, const CoordinateGroup& group,
                          const Configuration& a, const Configuration& b);
double rotationDifference(const ConfigurationSpace& space, const CoordinateGroup& group,
                          const Configuration& a, const Configuration& b);

}  // namespace corridor
