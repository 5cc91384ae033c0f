#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "planner/model/settings.h"
#include "planner/robot/curve.h"
#include "planner/solve/finish_path.h"

namespace corridor {

/// Decides whether a piece is proved free of contact, and to keep a fraction of the clearance
/// targets (curve_clearance.h): that of the part of the path that the piece replaces.
using CurveTest = std::function<bool(const CurvePiece&, double fraction)>;

/// How a path is smoothed.
struct SmoothOptions {
  /// The largest distance of a rounded corner from the path, in each number; rad or m.
  double deviation = std::numeric_limits<double>::infinity();
  /// For each number, its largest velocity and acceleration: the scales of lengths, and the limits
  /// with which times are estimated (curve_measure.h). Infinity: no limit. Empty: all are 1.
  Configuration velocity = {}, acceleration = {};
  /// The fraction of the clearance targets that each edge of the path keeps, or each piece of the
  /// curve (`shortenedCurve`). Empty: all are 0.
  std::vector<double> fractions = {};
  /// What smoothing reduces. `Smoothing::none`: no corner is rounded.
  Smoothing goal = Smoothing::time;
};

/// The result of smoothing, and its cost.
struct SmoothPath {
  std::vector<CurvePiece> pieces;  ///< lines and rounded corners, from the first state to the last
  std::vector<double> fractions;   ///< that each piece keeps of the clearance targets
  std::size_t corners = 0;         ///< corners of the path
  std::size_t rounded = 0;         ///< corners that became part of a proved curve
  std::size_t tests = 0;           ///< number of pieces that were tested
};

/// Rounds the corners of a path, so that a robot need not stop at them.
///
/// A corner is replaced by a curve of degree 5 from the edge before it to the edge after it. The
/// curve joins both edges with a continuous tangent and a second derivative of 0. Therefore the
/// whole result is C² for a suitable speed along it, except at corners that could not be rounded.
/// Each curve is used only if `isFree` proves it. Lines are parts of the path's edges, up to
/// rounding; they are not tested here.
///
/// 1. Each corner gets the largest curve that is proved. The first try takes half of the shorter
///    edge (up to 90 % of an edge at an end of the path), or less if `deviation` requires it. If a
///    try fails, the next try is half as large.
/// 2. Then the curve of each corner may also take those parts of the edges that the curves of the
///    neighbouring corners left.
/// 3. Two adjacent curves, with the edge between them, are replaced by one curve if it is proved
///    and the estimated time is at least 1 % shorter. This is done only if `deviation` is infinite.
///
/// A coordinate that is a rotation keeps its slerp on each edge. A corner where such a coordinate
/// moves on either edge is not rounded: a robot stops there. The values of circles in the result
/// are unwrapped: they continue beyond ±π, and whole turns count.
///
/// The result depends on the arguments only, as long as `stop` returns false. If `stop` returns
/// true, no further curve is tested.
/// @param path at least one state. Its edges are free.
/// @pre no edge is `ambiguous`.
SmoothPath smoothedPath(
    const ConfigurationSpace& space, const Path& path, const CurveTest& isFree,
    const SmoothOptions& options = {}, const std::function<bool()>& stop = [] { return false; });

}  // namespace corridor
