#pragma once

#include <string>

#include "tests/stress/audit/curve.h"
#include "tests/stress/audit/shapes.h"

namespace corridor::audit {

/// Kinds of edges: what moves, and how. Each kind stresses rounding or a bound in a different way.
enum class Family {
  planarBody,    ///< one rigid body, SE(2)
  spatialBody,   ///< one rigid body, SE(3)
  chain,         ///< one to eight joints
  branches,      ///< both bodies move, on two branches of one tree
  movingBase,    ///< a planar or floating base, and an arm on it
  mimics,        ///< joints that mimic another; the multiplier of a circle coordinate is an
                 ///< integer, that of a line coordinate is arbitrary
  farSlides,     ///< prismatic joints at up to 10^6 times the bodies' size
  manyTurns,     ///< revolute joints: up to 30 revolutions, at up to 10^7 rad
  halfTurns,     ///< rotations up to 2e-9 rad from a half turn
  nearlyEqual,   ///< the two states differ by 10^-3 to 10^-17
  scales,        ///< all lengths times 10^-6 to 10^6
  offsets,       ///< up to 10^6 m from the world's origin
  tinyBodies,    ///< bodies of 2e-5 m, 40 to 330 m from the origin
  reachingArm,   ///< only a prismatic joint at the end moves: the effect of a tube grows as the arm
                 ///< extends
  largeCircles,  ///< angles of continuous joints of 10^4 to 10^25 rad
};
inline constexpr Family kFamilies[] = {
    Family::planarBody, Family::spatialBody, Family::chain,       Family::branches,
    Family::movingBase, Family::mimics,      Family::farSlides,   Family::manyTurns,
    Family::halfTurns,  Family::nearlyEqual, Family::scales,      Family::offsets,
    Family::tinyBodies, Family::reachingArm, Family::largeCircles};
std::string nameOf(Family family);

/// Returns a random edge of the family. @param[out] size a size of bodies that suits this edge,
/// metres.
/// @param still if true, both states are equal.
Edge randomEdge(Dice& dice, Family family, bool still, double& size);

/// Returns whether a single rigid body moves in the world. Then the edge is also a `RigidMotion`.
bool isRigidBody(const Edge& edge);

}  // namespace corridor::audit
