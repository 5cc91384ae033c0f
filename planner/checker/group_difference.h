#pragma once

#include "planner/robot/configuration_space.h"

namespace corridor {

/// How far two configurations are apart in parts of them: lengths in metres, angles in radians, the
/// shorter way round, weights aside.

/// Of a line or a circle.
double differenceOf(const Coordinate& coordinate, const Configuration& a, const Configuration& b);

/// Of a planar or floating joint: |Δp|, and the angle of its rotation, in [0, π].
double positionDifference(const ConfigurationSpace& space, const CoordinateGroup& group,
                          const Configuration& a, const Configuration& b);
double rotationDifference(const ConfigurationSpace& space, const CoordinateGroup& group,
                          const Configuration& a, const Configuration& b);

}  // namespace corridor
