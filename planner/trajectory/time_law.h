#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "planner/model/limits.h"
#include "planner/robot/curve.h"
#include "planner/robot/kinematic_tree.h"

namespace corridor {

/// A part of a time law, inside one piece of the path. At a time t from `time` on, with
/// d = t − time, the law is at
///   τ(t) = tau + rate·d + acceleration·d²/2 + jerk·d³/6.
struct LawSegment {
  double time = 0, duration = 0;  ///< seconds; duration > 0
  std::size_t piece = 0;          ///< index into the path
  double tau = 0;                 ///< at the begin of the segment
  double rate = 0;                ///< dτ/dt there, 1/s
  double acceleration = 0;        ///< d²τ/dt² there, 1/s²
  double jerk = 0;                ///< constant, 1/s³
};

/// How long the limits of a number determine the law: the share of the duration in which the number
/// uses at least 99 % of its limit.
struct LimitUse {
  double velocity = 0, acceleration = 0;
};

struct TimeLawOptions {
  /// dτ/dt at the start of the first piece and at the end of the last one, 1/s, ≥ 0. The velocity
  /// there is rate·dq/dτ. 0: at rest.
  double startRate = 0, endRate = 0;
  /// The largest angle between the tangents of two pieces that the law passes through without a
  /// stop, radians. A jump by this angle changes the velocity by |q̇|·angle at once, so it must be
  /// small. The default allows for the rounding of files with seven digits.
  double cornerAngle = 1e-6;
  /// Makes the acceleration continuous, and keeps the limits of jerk (see `timeLaw`).
  bool smooth = false;
  /// Grid intervals of each run between two stops, before refinement.
  int intervals = 96;
};

/// The times at which a path is passed through.
struct TimeLaw {
  /// In the order of time, without gaps. Empty if the path has no length, or with a fault.
  std::vector<LawSegment> segments;
  double duration = 0;            ///< seconds
  std::vector<double> stopTimes;  ///< times between start and end at which the robot rests
  /// For each number of a Configuration (see JointLimits for positions and rotations).
  std::vector<LimitUse> use;
  TimeLawOptions options;  ///< with which the law was made
  /// The reason why there is no law, one line; or "".
  std::string fault;
};

/// Returns a law that passes through a path in the shortest time that velocity and acceleration
/// allow.
///
/// Method: reachability analysis (Pham and Pham 2018, "A New Approach to Time-Optimal Path
/// Parameterization Based on Reachability Analysis", IEEE Transactions on Robotics 34(3)). With
/// x = ṡ² and u = s̈, the limits at a point of the path are linear in (u, x):
///   |q'_j|²·x ≤ v_j²  and  |q'_j·u + q''_j·x| ≤ a_j.
/// On a grid s_0 … s_N with constant u in each interval, x_{i+1} = x_i + 2·Δ_i·u_i with Δ_i =
/// s_{i+1} − s_i.
/// 1. Backward pass: the controllable set K_i has all x from which K_{i+1} can be reached; it is an
///    interval (the first loop of their algorithm 1, TOPP-RA).
/// 2. Forward pass: from x_0 on, each interval gets the largest u with which x_{i+1} is in K_{i+1}
///    (the second loop).
/// The limits of an interval hold at both of its ends (their interpolation scheme).
/// Intervals are halved where u jumps, and where a parabola through the ends and the middle exceeds
/// a limit by more than 0.05 %.
///
/// - The path is split into runs. Between two runs the robot rests: at corners (see `cornerAngle`),
///   where a rotation changes its axis, and where the tangent of all numbers is 0. Pieces without
///   length are skipped.
/// - The law is optimal up to the grid. It exceeds limits between points of the grid to second
///   order only. This is no proof: `emitRows` proves the limits of the trajectory that it makes.
/// - For positions of planar and floating joints, the vector's length is limited. For
///   accelerations, a regular polygon of 32 sides inside the circle replaces the circle, so up to
///   0.5 % of the limit is not used.
/// - A limit of a link's speed bounds ṡ by the Jacobian at the points of the grid.
/// - `smooth`: the law of each run gets a continuous s̈ (smooth_law.h). The average of the law over
///   a window of time is used if it takes at most 1 % longer than the law without a limit of jerk.
///   Otherwise a search finds a locally fastest law (jerk_law.h). The result keeps the limits at
///   points of its grid. The path must start and end at rest.
///
/// Takes time linear in pieces and numbers.
/// @param tree is used only for the speeds of links.
/// Faults: a limit that is not positive for a number that moves; rates that no law can have, with
/// the largest one that is possible; coefficients or limits that are NaN; a smooth law that does
/// not start and end at rest.
TimeLaw timeLaw(const std::vector<CurvePiece>& path, const ConfigurationSpace& space,
                const JointLimits& limits, const KinematicTree& tree,
                const TimeLawOptions& options = {});

}  // namespace corridor
