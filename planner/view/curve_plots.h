#pragma once

#include <cstddef>
#include <vector>

#include "planner/robot/curve.h"

namespace corridor::view {

/// The data that plots of a trajectory show: joint values and components of poses, and their
/// derivatives, over time.
struct CurvePlots {
  struct Number {
    std::size_t coordinate = 0;                            ///< index into the space's coordinates
    std::vector<double> position, velocity, acceleration;  ///< at `times`, in m or rad and s
  };
  /// Seconds, ascending. The time of a knot between two pieces occurs twice: first for the values
  /// of the piece before the knot, then for those of the piece after it. Velocities and
  /// accelerations may jump at knots.
  std::vector<double> times;
  std::vector<Number> numbers;  ///< one for each coordinate, except rotations (quaternions)
};

/// Evaluates a curve at the ends of each piece, and at up to 39 instants inside each piece.
CurvePlots curvePlots(const ConfigurationSpace& space, const Curve& curve);

/// Returns the element of `limits` that limits a coordinate, or infinity if `limits` is empty. The
/// position of a planar or floating joint has one limit, for the length of its vector. This is the
/// element of the position's first coordinate, and it is returned for each coordinate of the
/// position.
double limitOf(const ConfigurationSpace& space, std::size_t coordinate,
               const Configuration& limits);

}  // namespace corridor::view
