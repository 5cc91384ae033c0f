#pragma once

#include <string>

#include "tests/stress/audit/curve.h"
#include "tests/stress/audit/shapes.h"

namespace corridor::audit {

/// What moves, and how. Each is a way in which rounding or a bound could go wrong.
enum class Family {
  planarBody,    ///< SE(2)
  spatialBody,   ///< SE(3)
  chain,         ///< one to eight joints
  branches,      ///< both bodies move, on two branches of one tree
  movingBase,    ///< a planar or floating base, and an arm on it
  mimics,        ///< joints that follow others: any multiplier on lines, whole ones on circles
  farSlides,     ///< prismatic joints up to 10^6 times as far out as the bodies are large
  manyTurns,     ///< joints that make up to 30 turns, at angles of up to 10^7 rad
  halfTurns,     ///< turns up to 2e-9 rad from a half turn
  nearlyEqual,   ///< states that differ by 10^-3 to 10^-17
  scales,        ///< all lengths times 10^-6 to 10^6
  offsets,       ///< up to 10^6 m from the world's origin
  tinyBodies,    ///< bodies of 2e-5 m at 40 to 330 m
  reachingArm,   ///< only the slide at an arm's end moves: its tube grows with its reach
  largeCircles,  ///< values of circles of 10^4 to 10^25 rad
};
inline constexpr Family kFamilies[] = {
    Family::planarBody, Family::spatialBody, Family::chain,       Family::branches,
    Family::movingBase, Family::mimics,      Family::farSlides,   Family::manyTurns,
    Family::halfTurns,  Family::nearlyEqual, Family::scales,      Family::offsets,
    Family::tinyBodies, Family::reachingArm, Family::largeCircles};
std::string nameOf(Family family);

/// A random edge of the family. @param[out] size  of the bodies that suit it, metres.
/// @param still  both states are the same.
Edge randomEdge(Dice& dice, Family family, bool still, double& size);

/// It is one rigid body in the world: `RigidMotion` can do it, too.
bool isRigidBody(const Edge& edge);

}  // namespace corridor::audit
