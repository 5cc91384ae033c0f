#pragma once

#include "tests/stress/audit/curve.h"
#include "tests/stress/audit/shapes.h"

namespace corridor::audit {

/// Gives the edge a piece of a curve of degree 1 to 9, made from the edge's two states. Then sets
/// these states to the ends of the piece. Each component of the configuration is constant, is
/// linear, stays near its chord, goes anywhere, reverses at the middle, or has large coefficients
/// that cancel. Rotation coordinates stay slerps.
/// @param size size of the bodies, metres: the scale of the motion of a position that is equal in
/// both states.
void bendEdge(Dice& dice, Edge& edge, double size);

/// Returns whether a coordinate of the configuration is an angle.
bool isAngle(const Edge& edge, const Coordinate& coordinate);

}  // namespace corridor::audit
