#pragma once

#include <optional>
#include <span>
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

/// A place where a curve is outside of the bounds of a coordinate, or where it could not be proved
/// to be within them.
struct OutsideBounds {
  std::size_t coordinate = 0;  ///< index into ConfigurationSpace::coordinates()
  std::size_t piece = 0;
  double t = 0;      ///< the parameter of the piece, in [0, 1]
  double value = 0;  ///< the value of the coordinate at t, m or rad
};

/// Proves that the line coordinates (Coordinate::Kind::line) of a curve stay within their bounds
/// everywhere, not only at the rows. For each coordinate for which the proof fails, returns a place
/// in the first piece for which it fails (verify/polynomial_range.h). The rows themselves are
/// compared exactly. Between the rows, the curve may be beyond a bound by the piece's error bound,
/// or by 2^-42 of its largest coefficient if that is less.
std::vector<OutsideBounds> outsideBounds(const ConfigurationSpace& space,
                                         std::span<const CurvePiece> pieces);

}  // namespace corridor
