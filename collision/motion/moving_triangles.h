#pragma once

#include "collision/motion/relative_motion.h"
#include "collision/predicates/triangle.h"

namespace corridor {

/// The result of one time interval for a triangle a at rest and a triangle b that moves.
struct MovingTrianglesAnswer {
  bool separated = false;  ///< proved farther apart than the margin, throughout
  double clearance = 0;    ///< `separated`: proved distance beyond the margin, metres
  /// At the rounded pose at the middle: touching, exactly, or proved to be within the margin.
  bool contact = false;
  /// Neither, and rounding and the tube alone prevent a proof at the middle: shorter intervals
  /// would not help.
  bool stuck = false;
  double bound = 0;  ///< bound of the motion of b's corners from the middle, metres
  /// If neither separated nor in contact: distance at the middle beyond the margin, metres.
  /// Rounded, for reports only.
  double gap = 0;
  bool exact = false;  ///< double could not decide the pair
};

/// Decides a pair of triangles in a time interval, b moving by the relative motion `relative`. It
/// tries to separate them along the direction of their closest points at the middle; each corner of
/// b has its own directional motion bound. Any direction is valid: its rounding may cost a proof,
/// but never makes one wrong. If they are not separated, contact at the middle is decided exactly.
MovingTrianglesAnswer decideMovingTriangles(const Triangle& a, const Triangle& b,
                                            const RelativeMotion& relative, double margin);

}  // namespace corridor
