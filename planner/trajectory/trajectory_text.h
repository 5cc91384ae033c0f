#pragma once

#include <string>

#include "planner/trajectory/trajectory_file.h"

/// Texts of trajectory files, which `readTrajectory` reads back as the same doubles. To write a
/// file whole or not at all, pass the text to `writeWhole` (planner/solve/whole_file.h).
namespace corridor {

/// Returns rows of numbers (CSV) under a header: `time` if the rows have times, then the names of
/// the space's numbers, then NAME_velocity and NAME_acceleration, if the rows have them.
std::string csvText(const TrajectoryRows& rows, const ConfigurationSpace& space);

/// Returns whether a space has a free rotation, which no JointTrajectory can hold.
bool hasRotation(const ConfigurationSpace& space);

/// Returns a trajectory_msgs/JointTrajectory of ROS 2 as YAML. Messages count whole nanoseconds, so
/// the times must be doubles that `nearestNanosecond` returns.
/// @throws std::invalid_argument for rows without times, a time that is negative or not such a
/// double, or a space with rotations.
std::string messageText(const TrajectoryRows& rows, const ConfigurationSpace& space);

/// Returns the double nearest to the whole number of nanoseconds that is nearest to a time.
/// @pre 0 ≤ seconds < 2^53 ns (104 days)
double nearestNanosecond(double seconds);

}  // namespace corridor
