#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "planner/robot/curve.h"
#include "planner/trajectory/trajectory_file.h"

namespace corridor {

/// What a robot does between two rows of a trajectory.
enum class RowInterpolation {
  linear,  ///< every number is linear in time
  cubic,   ///< the cubic polynomial with the positions and velocities of both rows
  quintic  ///< degree 5, with positions, velocities and accelerations of both rows
};
const char* nameOf(RowInterpolation between);

/// Returns `wanted` if it is set. Otherwise returns what the trajectory controllers of ros_control
/// and ros2_control do between rows: quintic if the file has accelerations, cubic if it has
/// velocities, else linear. Adds a note to the rows if velocities or accelerations are not used.
/// @throws InputError if the file lacks the values that `wanted` needs.
RowInterpolation interpolationOf(TrajectoryRows& rows, std::optional<RowInterpolation> wanted);

/// Returns the curve that the rows mean, with one piece from each row to the next. Its knots are
/// the times or, if the file has none, 0, 1, 2, … Angles are literal, and rotations go by slerp.
/// curve_pieces.h derives the error of the pieces. This error includes the rounding of a
/// controller's times, if the controller counts them in doubles from the begin of the file.
/// @throws InputError with all faults: a circle that jumps by more than half a turn from one row to
/// the next (which is a jump of the angle, not a motion); values that are too large.
Curve curveOf(const TrajectoryRows& rows, const ConfigurationSpace& space,
              RowInterpolation between);

/// A place where a curve is outside of the bounds of a coordinate.
struct OutsideBounds {
  std::size_t coordinate = 0;  ///< in the space
  std::size_t piece = 0;
  double t = 0;      ///< the parameter of the piece, in [0, 1]
  double value = 0;  ///< of the coordinate at t, m or rad
};

/// Proves that the line coordinates of a curve stay within their bounds everywhere, not only at its
/// rows. For each coordinate of which this can't be proved, returns a place in the first piece that
/// leaves the bounds (verify/polynomial_range.h). The rows themselves are compared exactly. Between
/// them, a value is not outside if it is beyond a bound by at most the rounding of the piece's
/// coefficients, which is below 2^-42 of them.
std::vector<OutsideBounds> outsideBounds(const ConfigurationSpace& space,
                                         std::span<const CurvePiece> pieces);

}  // namespace corridor
