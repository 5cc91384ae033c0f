#pragma once

#include <string>

#include "planner/checker/checker.h"
#include "planner/problem/problem.h"
#include "planner/solve/finish_path.h"
#include "planner/trajectory/rows_limits.h"

namespace corridor {

/// The files that a trajectory is written to.
enum class TrajectoryFileKind {
  csv,     ///< rows of numbers
  message  ///< a JointTrajectory of ROS 2, as YAML
};

/// A trajectory along a path, as it is written to a file, and the proof of that file.
struct MadeTrajectory {
  /// The content of the file; "" with a fault.
  std::string text;
  RowInterpolation between = RowInterpolation::cubic;  ///< what a controller does between the rows
  Curve curve;                                         ///< what the text means
  double duration = 0;                                 ///< seconds
  std::size_t rows = 0;
  std::size_t corners = 0, rounded = 0;  ///< corners of the path, and those without a stop
  std::size_t replaced = 0;              ///< parts of the curve that were replaced by better ones
  std::size_t curveTests = 0;            ///< curves that were tested to smooth the path
  LimitRatios ratios;                    ///< limitsOfRows, of the file's curve
  double stretch = 1;                    ///< how much the law was slowed down (Emission::stretch)
  /// `free`: the checker proved every piece of `curve`. Otherwise the answer for the first piece
  /// that it could not prove.
  MotionResult proof;
  std::size_t failedPiece = 0;  ///< without a proof: index into curve.pieces
  std::string fault;            ///< why there is no trajectory, one line; or ""
  /// Why the robot stops at all corners although some were rounded, one line; or "".
  std::string whyStops;

  /// Whether the file's curve is proved free and stays within the bounds of all joints.
  bool proved() const {
    return fault.empty() && proof.verdict == MotionVerdict::free &&
           ratios.position.share <= kLimitSlack;
  }
  /// Whether it is proved and keeps all limits.
  bool isGood() const { return proved() && keepsLimits(ratios); }
};

/// How often a trajectory is made at most, each time with a smaller deviation.
inline constexpr int kTrajectoryAttempts = 4;

/// Makes a trajectory along a path, by the problem's TrajectorySettings, in these steps:
/// 1. Corners are rounded by curves that the checker proves (smooth_path.h). Then parts of the
///    curve are replaced by better ones that the checker proves (shorten_curve.h). If this was to
///    save time and the law of the result is not faster, the replacements are dropped.
/// 2. A time law passes along the result in the shortest time that the problem's limits allow
///    (time_law.h). If a limit of jerk is given, the law keeps it.
/// 3. Rows are made of it (emit.h), and written as text.
/// 4. The text is read again. The checker proves each piece of the curve that it means, and its
///    limits are proved (rows_limits.h). If a piece can't be proved, or limits are exceeded, steps
///    2 to 4 are repeated up to three times, each time with a quarter of the deviation and, for
///    messages, with smaller limits. The last result that is proved is returned, even if it exceeds
///    a limit (`keepsLimits`).
/// 5. If this may be slower than stops at all corners, or is not good (`isGood`), steps 2 to 4 are
///    done for the path with stops, too, and the faster result is returned.
///
/// The times of a message are whole nanoseconds. Each row has the position of its rounded time.
/// (That of the time itself would change the acceleration of a cubic by 6|v|·1e-9/T², and the jerk
/// of a quintic by 60|v|·1e-9/T³, where T is the time between two rows.)
///
/// The result depends on the arguments only, unless `stop` returns true: then the curve stays
/// as it is.
/// @param path its edges should be free: if one is not, the result is not proved.
MadeTrajectory makeTrajectory(
    const Problem& problem, const Checker& checker, const Path& path,
    TrajectoryFileKind kind = TrajectoryFileKind::csv,
    const std::function<bool()>& stop = [] { return false; });

/// Makes a trajectory along a curve: steps 2 to 4 of `makeTrajectory`, for curves from elsewhere.
/// The members `corners`, `rounded`, `replaced` and `curveTests` of the result are 0.
/// @param attempts how often steps 2 to 4 are done at most. 1: with the deviation of the settings
/// only.
MadeTrajectory trajectoryAlong(const Problem& problem, const Checker& checker,
                               const std::vector<CurvePiece>& curve,
                               TrajectoryFileKind kind = TrajectoryFileKind::csv,
                               int attempts = kTrajectoryAttempts);

}  // namespace corridor
