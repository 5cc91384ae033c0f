#pragma once

#include "planner/robot/configuration_space.h"
#include "planner/robot/curve.h"

/// Functions that several steps of smoothing use.
namespace corridor {

/// Returns whether a rotation differs between two configurations.
bool rotates(const ConfigurationSpace& space, const Configuration& from, const Configuration& to);

/// Sets the rotations of a piece to those of a configuration, in all columns, so that they rest.
void restRotations(const ConfigurationSpace& space, const Configuration& q, CurvePiece& piece);

/// Returns whether the Bernstein coefficients of all coordinates that are lines are within their
/// bounds. If so, the whole piece is within the bounds.
bool isWithinBounds(const ConfigurationSpace& space, const CurvePiece& piece);

}  // namespace corridor
