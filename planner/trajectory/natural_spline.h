#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "planner/robot/curve.h"

/// Cubic splines through the states of a path, as retiming tools make them. Nothing about them is
/// proved: they leave the path between its states. They serve for comparison.
namespace corridor {

/// Returns the states of a path, without repeated ones, as values that are literal: circles
/// continue beyond ±π. @param lines the path's edges, as `curveOfPath` returns them.
std::vector<Configuration> statesOfLines(const std::vector<CurvePiece>& lines);

/// Returns the natural cubic spline through the states: twice continuously differentiable, with a
/// second derivative of 0 at both ends, and chord lengths as parameters (de Boor, A Practical Guide
/// to Splines, chapter IV). Each pair of consecutive states has one Bernstein piece. Takes linear
/// time. The returned coefficients define the curve, so the `error` of each piece is 0.
/// @pre two states or more, of which no two adjacent ones are equal; the space has no rotation.
std::vector<CurvePiece> naturalSpline(const std::vector<Configuration>& states);

struct InsertedSpline {
  std::vector<CurvePiece> pieces;
  std::size_t inserted = 0;  ///< the number of inserted states
  bool touches = false;      ///< whether a sample still touches after the last insertion
};

/// Returns the natural spline after states were inserted by trial. While a sample of the spline
/// touches something, the first piece that touches is found, and the middle of the path's edge
/// between the same two states becomes a state, too. Samples are at most `step` apart (rad and m,
/// in the norm of all numbers).
/// @param touches whether a configuration touches something.
/// @param most how many states are inserted at most.
/// @pre the same as for naturalSpline.
InsertedSpline insertedSpline(const ConfigurationSpace& space, std::vector<Configuration> states,
                              const std::function<bool(const Configuration&)>& touches,
                              double step = 0.05, std::size_t most = 20);

}  // namespace corridor
