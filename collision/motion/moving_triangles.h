#pragma once

#include "collision/motion/relative_motion.h"
#include "collision/predicates/triangle.h"

namespace corridor {

/// The result of one time interval for a triangle a at rest and a triangle b that moves. The
/// results for convex parts have the same form (moving_parts.h).
struct MovingPairAnswer {
  bool separated = false;  ///< proved farther apart than the margin throughout the interval
  double clearance = 0;    ///< `separated`: proved distance beyond the margin, metres
  /// At the rounded pose at the middle the triangles touch (decided exactly), or are proved to be
  /// within the margin.
  bool contact = false;
  /// Neither separated nor in contact, and rounding and tube alone prevent a proof at the middle.
  /// Shorter intervals would not help.
  bool stuck = false;
  double bound = 0;  ///< bound of the motion of b from the middle, metres; 0 if separated
  /// If neither separated nor in contact: distance at the middle beyond the margin, metres. It is
  /// rounded, and only used for reports.
  double gap = 0;
  bool exact = false;  ///< double could not decide the pair, so slower arithmetic was used
};

/// Decides a pair of triangles in a time interval. b moves by the relative motion `relative`. The
/// test tries to separate the triangles along the direction of their closest points at the middle.
/// Each corner of b has its own directional motion bound. Any direction is valid: the rounding of
/// the direction may prevent a proof, but never makes a proof wrong. If the triangles are not
/// separated, contact at the middle is decided exactly.
MovingPairAnswer decideMovingTriangles(const Triangle& a, const Triangle& b,
                                       const RelativeMotion& relative, double margin);

}  // namespace corridor
