#pragma once

#include "collision/core/counters.h"
#include "collision/motion/motion_window.h"
#include "collision/predicates/triangle.h"

namespace corridor {

/// What a window of time says of a triangle a at rest and a triangle b that moves.
struct MovingTrianglesAnswer {
  bool separated = false;  ///< proved farther apart than the margin, all along the window
  double clearance = 0;    ///< `separated`: by how much, proved; metres
  bool contact =
      false;  ///< at the rounded pose of the middle: exactly touching, or proved within the margin
  bool stuck = false;  ///< neither, and rounding and the tube alone forbid a proof at the middle:
                       ///< no shorter window has one
  double travel = 0;   ///< bound of how far a corner of b goes from the middle, metres
  double gap =
      0;  ///< distance at the middle beyond the margin, where neither; rounded, for reports
};

/// Separation along the direction of the closest points at the middle: any direction is legal, so
/// that rounding in finding it costs power, never soundness. Each corner goes along it by its own
/// directional bound.
MovingTrianglesAnswer decideMovingTriangles(const Triangle& a, const Triangle& b,
                                            const MotionWindow& window, double margin,
                                            Counters& counters);

}  // namespace corridor
