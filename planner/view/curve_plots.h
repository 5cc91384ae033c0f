#pragma once

#include <cstddef>
#include <vector>

#include "planner/robot/curve.h"

namespace corridor::view {

/// The values that plots of a trajectory show: its numbers and their derivatives over time.
struct CurvePlots {
  struct Number {
    std::size_t coordinate = 0;                            ///< in the space
    std::vector<double> position, velocity, acceleration;  ///< at `times`; m or rad, s
  };
  /// Seconds, ascending. A knot between two pieces occurs twice: first with the values of the piece
  /// before it, then with those of the piece after it. Velocities and accelerations may jump there.
  std::vector<double> times;
  std::vector<Number> numbers;  ///< one for each line and circle; none for rotations
};

/// Evaluates a curve at the ends of each piece, and at up to 39 instants inside each piece.
CurvePlots curvePlots(const ConfigurationSpace& space, const Curve& curve);

/// Returns the limit of a line or circle: the element of `limits` for the coordinate's number. The
/// position of a planar or floating joint has one limit for the length of its vector. It is the
/// element of the position's first number, and is returned for each coordinate of the position.
/// Returns infinity if `limits` is empty.
double limitOf(const ConfigurationSpace& space, std::size_t coordinate,
               const Configuration& limits);

}  // namespace corridor::view
