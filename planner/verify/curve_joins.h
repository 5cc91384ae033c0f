#pragma once

#include <vector>

#include "planner/robot/curve.h"

namespace corridor::verify {

/// Returns whether a piece begins where the piece before it ends, up to the errors of both: whether
/// a point exists that is within the errors of both ends. Circles count literally, so a difference
/// of whole turns is a jump.
///
/// The decision is exact for lines and circles, and for equal rotations. For other rotations,
/// `true` means that the angle between them is at most the sum of both errors. `false` means that
/// it is larger than this sum minus 2^-56 rad: 2^-58 rad exceeds the rounding of the angle (64u, u
/// = 2^-64; see EdgeCurve), and a share of 2^-60 that of the sum.
/// @pre both pieces have finite coefficients, and as many numbers as the coordinates.
bool joins(const std::vector<Coordinate>& coordinates, const CurvePiece& before,
           const CurvePiece& after);

}  // namespace corridor::verify
