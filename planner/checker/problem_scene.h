#pragma once

#include "collision/world/scene.h"
#include "planner/checker/rigid_state.h"

namespace corridor {

/// The bodies of a problem; no tree is built yet.
Scene makeScene(const Problem& problem);

/// Tolerance, margin and tube that a problem asks for; the tube is never less than what covers
/// rounding: 2^-40 of each coordinate's range (design: contract 2), for positions of the longest
/// one.
MotionOptions motionOptions(const Problem& problem, const Scene& scene);

/// Quaternions normalised.
RigidState startState(const Problem& problem);
RigidState goalState(const Problem& problem);

/// Is the state in the goal: the region, or the .cfg's threshold, or else the goal state itself but
/// for the rounding of its quaternion? @param slack of a length or an angle, as a fraction: > 0
/// forgives, < 0 is strict.
bool inGoal(const Problem& problem, const RigidState& state, double slack = 0);

}  // namespace corridor
