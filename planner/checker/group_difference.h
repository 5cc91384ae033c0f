#pragma once

#include "planner/robot/configuration_space.h"

namespace corridor {

/// Distances of two configurations in some of their coordinates: lengths in metres, angles in
/// radians the shorter way round, without weights.

/// Returns the difference in a line or a circle, ≥ 0.
double differenceOf(const Coordinate& coordinate, const Configuration& a, const Configuration& b);

/// Return, for a planar or floating joint, |Δp| and the angle of its rotation, in [0, π].
double positionDifference(const ConfigurationSpace& space, const CoordinateGroup& group,
                          const Configuration& a, const Configuration& b);
double rotationDifference(const ConfigurationSpace& space, const CoordinateGroup& group,
                          const Configuration& a, const Configuration& b);

}  // namespace corridor
