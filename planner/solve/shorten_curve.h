#pragma once

#include <functional>
#include <vector>

#include "planner/solve/smooth_path.h"

namespace corridor {

/// The result of shortening a curve, and its cost.
struct ShortCurve {
  std::vector<CurvePiece> pieces;
  std::size_t replaced = 0;  ///< number of parts that were replaced
  std::size_t tests = 0;     ///< number of pieces that were tested
};

/// Replaces parts of a curve by single pieces of degree 5, if this reduces the measure that
/// `options.goal` chooses: time, length or acceleration.
///
/// At both of its ends, a replacement has the position, the tangent and the curvature of the curve.
/// So the result is C² for a suitable speed along it, except where the given curve is not C² and no
/// part was replaced. At the first and the last point of the curve, where the robot rests, the
/// direction may change. Each replacement is used only if `isFree` proves it. So if the given curve
/// was proved, the result is proved, too, up to the rounding of pieces that were split.
///
/// Parts of many lengths are tried in a fixed order, from the whole curve down to a 16th of it.
/// This is repeated, at most four times in all, as long as something improves. This is the shortcut
/// method of Hauser and Ng-Thow-Hing ("Fast Smoothing of Manipulator Trajectories using Optimal
/// Bounded-Acceleration Shortcuts", ICRA 2010), without a time law and without random numbers.
///
/// Pieces that change a rotation in space stay as they are, and the robot rests before and after
/// them. The result depends on the arguments only, as long as `stop` returns false. If `stop`
/// returns true, no further curve is tested.
ShortCurve shortenedCurve(
    const ConfigurationSpace& space, std::vector<CurvePiece> pieces, const CurveTest& isFree,
    const SmoothOptions& options = {}, const std::function<bool()>& stop = [] { return false; });

}  // namespace corridor
