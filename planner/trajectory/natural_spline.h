#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "planner/robot/curve.h"

/// Cubic splines through the states of a path, as retiming tools make them, for comparison. Nothing
/// about the splines is proved: they leave the path between its states.
namespace corridor {

/// Returns the states of a path. If adjacent states are equal, only one of them is returned. Angles
/// of circle coordinates (continuous joints, yaws) are literal: they continue beyond ±π. @param
/// lines the path's edges, as `curveOfPath` returns them.
std::vector<Configuration> statesOfLines(const std::vector<CurvePiece>& lines);

/// Returns the natural cubic spline through the states: twice continuously differentiable, with a
/// second derivative of 0 at both ends, and chord lengths as parameters (de Boor, A Practical Guide
/// to Splines, chapter IV). Each pair of consecutive states has one Bernstein piece. Takes linear
/// time. The returned coefficients define the curve, so the `error` of each piece is 0.
/// @pre There are two states or more, no two adjacent states are equal, and the space has no
/// rotation coordinate (quaternion).
std::vector<CurvePiece> naturalSpline(const std::vector<Configuration>& states);

struct InsertedSpline {
  std::vector<CurvePiece> pieces;
  std::size_t inserted = 0;  ///< the number of inserted states
  bool touches = false;      ///< whether a sample of `pieces` still touches something
};

/// Returns the natural spline after states were inserted by trial. While a sample of the spline
/// touches something, the first piece with such a sample is found, and a state is inserted: the
/// middle of the straight line between the two states at the ends of this piece. Samples are at
/// most `step` apart, in the Euclidean norm over all components (rad and m).
/// @param touches returns whether a configuration touches something.
/// @param most the largest number of states that are inserted.
/// @pre The preconditions of naturalSpline hold.
InsertedSpline insertedSpline(const ConfigurationSpace& space, std::vector<Configuration> states,
                              const std::function<bool(const Configuration&)>& touches,
                              double step = 0.05, std::size_t most = 20);

}  // namespace corridor
