#pragma once

#include "planner/robot/configuration_space.h"
#include "planner/robot/curve.h"

/// What the steps of smoothing share.
namespace corridor {

/// Returns whether a rotation differs between two configurations.
bool rotates(const ConfigurationSpace& space, const Configuration& from, const Configuration& to);

/// Sets the rotations of a piece to those of a configuration, in all columns: they rest.
void restRotations(const ConfigurationSpace& space, const Configuration& q, CurvePiece& piece);

/// Returns whether the Bernstein coefficients of all lines are within their bounds. Then the piece
/// is.
bool isWithinBounds(const ConfigurationSpace& space, const CurvePiece& piece);

}  // namespace corridor
