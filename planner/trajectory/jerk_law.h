#pragma once

#include <vector>

#include "planner/model/limits.h"
#include "planner/robot/kinematic_tree.h"
#include "planner/trajectory/path_runs.h"
#include "planner/trajectory/time_law.h"

namespace corridor {

/// Returns a time law of a run (path_runs.h), from rest to rest. The law is locally the fastest one
/// under the limits of velocity, acceleration and jerk.
///
/// Method: the law is described by y(σ) = σ̇², where s(σ) is a fixed map of a parameter to the path:
/// s = σ + constant, except near both ends, where s ~ σ³, because a law of bounded jerk leaves rest
/// like t³. With u = σ̈ = y′/2 and w = y″/2, for the path Q(σ) = q(s(σ)),
///   q̇ = Q′·√y,  q̈ = Q″·y + Q′·u,  q⃛ = (Q‴·y + 3Q″·u + Q′·w)·√y.
/// y is a spline of degree 2 (u′ = w is constant between knots). The limits hold at both ends and
/// in the middle of each interval between knots. A barrier method minimises the time ∫ dσ/√y under
/// these limits. The limits of velocity and acceleration are convex in y. The limit of jerk is not:
/// the Hessian of its barrier is replaced by a positive semidefinite matrix, so that each step
/// makes the law better. (Barrier methods: Boyd and Vandenberghe, Convex Optimization, chapter 11.
/// The same constraints are found in Debrouwere et al. 2013, "Time-Optimal Path Following for
/// Robots With Convex–Concave Constraints Using Sequential Convex Programming", IEEE Transactions
/// on Robotics 29(6).) The search is done twice. In the second search, the first knots are at about
/// equal times of the first search's result.
///
/// Returns an empty law if the search fails. The running time is linear in the number of pieces and
/// in the number of components of a configuration. It is also linear in the law's duration, divided
/// by the shortest time in which the largest jerk takes a component from no acceleration to its
/// limit of acceleration.
/// @param start a law from rest to rest, at rest only at its ends. It need not keep any limit. The
/// first search starts with this law, and its first knots are at about equal times of this law.
std::vector<LawSegment> jerkLimitedLaw(const PathView& view, const PathRun& run,
                                       const JointLimits& limits, const KinematicTree& tree,
                                       const std::vector<LawSegment>& start);

}  // namespace corridor
