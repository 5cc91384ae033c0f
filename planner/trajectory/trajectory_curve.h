#pragma once

#include <optional>
#include <string>
#include <vector>

#include "planner/robot/curve.h"
#include "planner/trajectory/trajectory_file.h"

namespace corridor {

/// The curve of each component of a configuration between two rows of a trajectory.
enum class RowInterpolation {
  linear,  ///< linear in time
  cubic,   ///< the cubic polynomial with the positions and velocities of both rows
  quintic  ///< the polynomial of degree 5 with the positions, velocities and accelerations of both
           ///< rows
};
const char* nameOf(RowInterpolation between);

/// Returns `wanted` if it is set. Otherwise returns what the trajectory controllers of ros_control
/// and ros2_control do between rows: quintic if the file has accelerations, cubic if it has
/// velocities, else linear. Adds a note to the rows if velocities or accelerations are not used.
/// @throws InputError if the file lacks the values that `wanted` needs.
RowInterpolation interpolationOf(TrajectoryRows& rows, std::optional<RowInterpolation> wanted);

/// Returns the curve that the rows mean, with one piece from each row to the next. The knots are
/// the times of the rows or, if the file has no times, 0, 1, 2, … Angles are literal, and rotations
/// are interpolated by slerp. curve_pieces.h derives the error of the pieces. This error includes
/// the rounding of a controller's times, if the controller counts them in doubles from the begin of
/// the file.
/// @throws InputError if a circle coordinate (a continuous joint, or a yaw) turns by more than half
/// a turn from one row to the next, or if values are too large. Such a turn is a jump of the angle,
/// not a motion. The error has the faults of the first faulty row, and says how many more rows have
/// faults.
Curve curveOf(const TrajectoryRows& rows, const ConfigurationSpace& space,
              RowInterpolation between);

}  // namespace corridor
