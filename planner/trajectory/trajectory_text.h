#pragma once

#include <string>

#include "planner/trajectory/trajectory_file.h"

/// Functions that make the texts of trajectory files. `readTrajectory` reads such a text back as
/// the same doubles. To write a file completely or not at all, pass the text to `writeWhole`
/// (collision/core/whole_file.h).
namespace corridor {

/// Returns a CSV text with a header line: `time` if the rows have times, then the names of the
/// components (`numberNames`), then NAME_velocity and NAME_acceleration, if the rows have them.
/// Names with blanks, commas and the like are in quotes. Where a joint has such a name, a column
/// gets another that `readTrajectory` takes for it: time_from_start, velocity/NAME. Components of
/// rotations have no velocities and accelerations in the text.
/// @throws std::invalid_argument if the names of joints leave no name for a column.
std::string csvText(const TrajectoryRows& rows, const Model& model);

/// Returns whether a space has a rotation coordinate (a quaternion). A JointTrajectory can't
/// contain quaternions.
bool hasRotation(const ConfigurationSpace& space);

/// Returns a trajectory_msgs/JointTrajectory of ROS 2 as YAML. Messages count whole nanoseconds, so
/// the times must be doubles that `nearestNanosecond` returns.
/// @throws std::invalid_argument if the rows have no times, if a time is negative or not such a
/// double, or if the space has rotations.
std::string messageText(const TrajectoryRows& rows, const ConfigurationSpace& space);

/// Returns the double nearest to the whole number of nanoseconds that is nearest to a time.
/// @pre 0 ≤ seconds < 2^53 ns (104 days)
double nearestNanosecond(double seconds);

}  // namespace corridor
