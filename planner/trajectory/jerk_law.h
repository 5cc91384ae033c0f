#pragma once

#include <vector>

#include "planner/model/limits.h"
#include "planner/robot/kinematic_tree.h"
#include "planner/trajectory/path_runs.h"
#include "planner/trajectory/time_law.h"

namespace corridor {

/// Returns a law of a run, from rest to rest, that is locally the fastest one under the limits of
/// velocity, acceleration and jerk.
///
/// Method: the law is described by y(σ) = σ̇², where s(σ) is a fixed map of a parameter to the path:
/// s = σ + constant, except near both ends, where s ~ σ³, because a law of bounded jerk leaves rest
/// like t³. With u = σ̈ = y′/2 and w = y″/2, for the path Q(σ) = q(s(σ)),
///   q̇ = Q′·√y,  q̈ = Q″·y + Q′·u,  q⃛ = (Q‴·y + 3Q″·u + Q′·w)·√y.
/// y is a spline of degree 2 (u′ = w is constant between knots). The limits hold at both ends and
/// in the middle of each interval between knots. The time ∫ dσ/√y is minimised under them by a
/// barrier method: the first two limits are convex in y; the Hessian of the third one's barrier is
/// replaced by one that is positive semidefinite, so that each step makes the law better. (Barrier
/// methods: Boyd and Vandenberghe, Convex Optimization, chapter 11. The same constraints are found
/// in Debrouwere et al. 2013, "Time-Optimal Path Following for Robots With Convex–Concave
/// Constraints Using Sequential Convex Programming", IEEE Transactions on Robotics 29(6).) This is
/// done twice; the second time, knots stand at equal times of the first result.
///
/// Returns an empty law if the search fails.
/// @param start a law from rest to rest, at rest only at its ends. It need not keep any limit.
/// Knots stand at about equal times of it, and it is where the search starts.
/// Takes time linear in pieces, numbers, and the duration over the shortest time in which a number
/// reaches its acceleration.
std::vector<LawSegment> jerkLimitedLaw(const PathView& view, const PathRun& run,
                                       const JointLimits& limits, const KinematicTree& tree,
                                       const std::vector<LawSegment>& start);

}  // namespace corridor
