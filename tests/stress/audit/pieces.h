#pragma once

#include "tests/stress/audit/curve.h"
#include "tests/stress/audit/shapes.h"

namespace corridor::audit {

/// Makes the edge a piece of a curve of degree 1 to 9 between its states: each number rests, is
/// linear, is near its chord or anywhere, turns round at the middle, or has large coefficients that
/// cancel. Rotations stay slerps.
/// @param size of the bodies, metres: the scale of positions that leave their place and return.
void bendEdge(Dice& dice, Edge& edge, double size);

/// Returns whether a number of the configuration is an angle.
bool isAngle(const Edge& edge, const Coordinate& coordinate);

}  // namespace corridor::audit
