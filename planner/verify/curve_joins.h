#pragma once

#include <vector>

#include "planner/robot/curve.h"

namespace corridor::verify {

/// Returns whether a piece begins where the piece before it ends, up to the `error` of both:
/// whether some configuration is within the errors of both ends. The angles of circles are compared
/// as numbers, so a difference of whole turns is a jump.
///
/// The decision is exact for coordinates that are lines or circles, and for equal rotations. For
/// other rotations, `true` means that the angle between them is at most the sum of both errors.
/// `false` means that the angle is larger than this sum minus 2^-56 rad. The reason: the test
/// allows 2^-58 rad for the rounding of the angle (64u, u = 2^-64; see EdgeCurve), and 2^-60 of the
/// sum for the rounding of the sum.
/// @pre both pieces have finite coefficients, and one row for each number of a configuration.
bool joins(const std::vector<Coordinate>& coordinates, const CurvePiece& before,
           const CurvePiece& after);

}  // namespace corridor::verify
