#pragma once

#include <string>

#include "planner/checker/checker.h"
#include "planner/problem/problem.h"
#include "planner/solve/curve_clearance.h"
#include "planner/solve/finish_path.h"
#include "planner/trajectory/rows_limits.h"

namespace corridor {

/// The files that a trajectory is written to.
enum class TrajectoryFileKind {
  csv,     ///< rows of numbers
  message  ///< a JointTrajectory of ROS 2, as YAML
};

/// A trajectory along a path: the content of its file, and the proof of this content.
struct MadeTrajectory {
  /// The content of the file; "" if there is a `fault`.
  std::string text;
  RowInterpolation between = RowInterpolation::cubic;  ///< what a controller does between the rows
  Curve curve;                                         ///< the curve that the text describes
  double duration = 0;                                 ///< seconds
  std::size_t rows = 0;
  std::size_t corners = 0, rounded = 0;  ///< corners of the path; corners without a stop
  std::size_t replaced = 0;              ///< parts of the curve that were replaced by better ones
  std::size_t curveTests = 0;            ///< pieces of curves that were tested to smooth the path
  LimitRatios ratios;                    ///< by limitsOfRows, for the file's curve
  double stretch = 1;  ///< factor by which the time law was slowed down (Emission::stretch)
  /// The checker's answer: the verdict is `free` if every piece of `curve` is proved. Otherwise
  /// `proof` is the answer for the first piece that could not be proved.
  MotionResult proof;
  std::size_t failedPiece = 0;  ///< if there is no proof: index into curve.pieces
  /// The clearance of `curve`; set if it is proved, and `makeTrajectory` got targets.
  std::optional<CurveProof> clearance;
  /// Seconds by which this trajectory is longer than the law along the curve that is made without
  /// clearance targets; 0 if the targets changed nothing. It can be negative: smoothing is a
  /// heuristic. Not set without `clearance`, or if time ran out.
  std::optional<double> timeLost;
  /// Whether the curve misses targets, although the path keeps all; or its proved clearance is less
  /// than the path's.
  bool losesClearance = false;
  std::string fault;  ///< why there is no trajectory, one line; or ""
  /// Why the robot stops at all corners although some were rounded, one line; or "".
  std::string whyStops;

  /// Whether the file's curve is proved free and stays within the bounds of all joints.
  bool proved() const {
    return fault.empty() && proof.verdict == MotionVerdict::free &&
           ratios.position.share <= kLimitSlack;
  }
  /// Whether the file's curve is proved (see `proved`), keeps all limits, and no pair comes closer
  /// than on the path because of it.
  bool isGood() const { return proved() && keepsLimits(ratios) && !losesClearance; }
};

/// The maximum number of times that a trajectory is made, each time with a smaller deviation.
inline constexpr int kTrajectoryAttempts = 4;

/// Makes a trajectory along a path, by the problem's TrajectorySettings, in these steps:
/// 1. Corners are rounded by curves that the checker proves (smooth_path.h). Then parts of the
///    curve are replaced by better ones that the checker proves (shorten_curve.h). They are not
///    replaced for `Smoothing::none` and `Smoothing::corners`, nor if the distance of rounded
///    corners from the path is limited. If smoothing shall reduce the time (`Smoothing::time`), and
///    the law along the result is not faster, the replacements are dropped.
/// 2. A time law passes along the curve in the shortest time that the problem's limits allow
///    (time_law.h). If a limit of jerk is given, the law keeps this limit, too.
/// 3. Rows are computed from the law (emit.h), and written as text.
/// 4. The text is read again. The checker proves each piece of the curve that the text describes.
///    Then it is proved which limits this curve keeps (rows_limits.h). If a piece can't be proved,
///    or limits are exceeded, steps 2 to 4 are repeated up to three times, each time with a quarter
///    of the deviation and, for messages, with smaller limits. The last result that is proved is
///    returned, even if it exceeds a limit (`keepsLimits`).
/// 5. If this result may be slower than a path with stops at all corners, or is not good
///    (`isGood`), steps 2 to 4 are done for the path with stops, too. The result with stops is
///    returned in three cases: only it is good; both results are good and it is faster; or only it
///    is proved.
///
/// The times of a message are whole nanoseconds. Each row has the position at its rounded time.
/// (Let v be the velocity, and T the time between two rows. The position at the unrounded time
/// would change the acceleration of a cubic by 6|v|·1e-9/T², and the jerk of a quintic by
/// 60|v|·1e-9/T³.)
///
/// The result depends on the arguments only, unless `stop` returns true: then smoothing ends, and
/// the curve stays as it is.
/// @param path its edges should be free: if one is not, the result is not proved.
/// @param clearance if not null, the curve keeps the clearance targets where the path keeps them,
/// and elsewhere the fraction of them that the path keeps.
MadeTrajectory makeTrajectory(
    const Problem& problem, const Checker& checker, const Path& path,
    TrajectoryFileKind kind = TrajectoryFileKind::csv,
    const std::function<bool()>& stop = [] { return false; },
    const CurveClearance* clearance = nullptr);

/// Makes a trajectory along a curve: steps 2 to 4 of `makeTrajectory`, for curves from elsewhere.
/// The members `corners`, `rounded`, `replaced` and `curveTests` of the result are 0.
/// @param attempts the maximum number of times that steps 2 to 4 are done. 1: only once, with the
/// deviation of the settings.
MadeTrajectory trajectoryAlong(const Problem& problem, const Checker& checker,
                               const std::vector<CurvePiece>& curve,
                               TrajectoryFileKind kind = TrajectoryFileKind::csv,
                               int attempts = kTrajectoryAttempts);

}  // namespace corridor
