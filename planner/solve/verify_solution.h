#pragma once

#include <string>
#include <vector>

#include "planner/solve/solution.h"
#include "planner/trajectory/rows_limits.h"
#include "planner/verify/verify_path.h"

namespace corridor {

/// The result of comparing a solution's digest with that of a problem (planner/problem/digest.h).
enum class DigestState {
  same,     ///< the solution was made for these files
  differs,  ///< the problem or one of its files has changed, or it is another problem
  none      ///< the solution has no digest: it was written by hand, or is a `.path` file
};
const char* nameOf(DigestState state);

/// What to do with a solution whose digest differs from the problem's.
enum class DigestMismatch {
  refused,  ///< it is not verified: a proof would be for another problem than the solution's
  ignored   ///< it is verified for this problem
};

/// The verifier's report on a solution of a problem.
struct VerifyReport {
  PathVerdict verdict = PathVerdict::proved;
  DigestState digest = DigestState::none;
  /// True if the digest differs and was not ignored. Then nothing was verified, and `verdict` is
  /// `undecided`.
  bool otherProblem = false;
  PathReport pathReport;  ///< planner/verify's report on contacts and clearances
  /// Faults of start, goal and bounds, one line each.
  std::vector<std::string> violations;
  bool reachesGoal = true;  ///< the last state is in the goal
  double margin = 0;        ///< metres
  Configuration tube;       ///< the tube of the proof, as Task::tube
  /// The interpolation between the rows of a trajectory; not set for a solution.
  std::optional<RowInterpolation> between;
  /// The time of each row of a trajectory, seconds; empty if it has no times. An edge of
  /// `pathReport` is the curve from one row to the next.
  std::vector<double> times;
  /// For each kind of limit, the largest fraction of a limit that the trajectory uses, proved for
  /// all times; set only for a trajectory with times. The verdict does not depend on them.
  std::optional<LimitRatios> limits;
  std::vector<Note> notes;  ///< notes on a trajectory's file, start and end
};

const char* nameOf(PathVerdict verdict);
/// Returns "proved", "refuted", "undecided", or "other problem".
const char* verdictName(const VerifyReport& report);

/// Returns the first violation or finding in one line, with the edge or the time at which it is; ""
/// if there is none.
std::string firstFinding(const VerifyReport& report);

/// Returns the plain data that planner/verify reads: the model's bodies, the pairs that its filter
/// does not exclude for the task's margin, padding and tube (`requiredBy`), and the task's margin
/// and tube. Pairs that were proved never in contact are left out only if their proof covers the
/// task; paths that leave the values for which it holds are then not proved (`provedBox`). Pairs
/// with only held joints between them are `PathProblem::heldPairs`. The model must outlive the
/// result.
/// @throws std::invalid_argument if a body without a robot is on a frame that moves.
/// @param tolerance the checker's tolerance, metres; the verifier uses a tenth of it. Unset: the
/// verifier uses a tenth of the default tolerance for the smallest tested shape (for a shape of 1 m
/// if all are larger). This may differ from a tenth of the checker's default.
PathProblem plainProblem(const Model& model, const Task& task,
                         const std::optional<double>& tolerance = {});
PathProblem plainProblem(const Problem& problem);
PathProblem plainProblem(Problem&& problem) = delete;  ///< a temporary would not outlive the result

/// Verifies that the path begins at the start, ends in the goal and stays in the bounds. Then
/// planner/verify verifies that every curve in the problem's tube around the path keeps the
/// problem's margin. planner/verify shares no bounds, poses or trees with the checker of the
/// planner. If the solution has a digest, the digest is first compared with that of the problem's
/// files, which are read again for this purpose. If the digests differ, nothing is verified, unless
/// `other` is `ignored`.
/// @throws InputError if one of the problem's files can't be read.
VerifyReport verifySolution(const Problem& problem, const Solution& solution,
                            DigestMismatch other = DigestMismatch::refused);

/// Verifies a trajectory (planner/trajectory/README.md): planner/verify verifies that every curve
/// in the problem's tube around the curve between the rows keeps the problem's margin. The whole
/// curve must be within the bounds, not only its rows.
///
/// A trajectory does not claim to solve the problem. If it does not begin at the problem's start,
/// or does not end in the goal, a note says so, and the verdict is the same.
/// @param between the interpolation between rows. nullopt: interpolationOf chooses it, by whether
/// the rows have velocities and accelerations.
/// @throws InputError: as interpolationOf and curveOf.
VerifyReport verifyTrajectory(const Problem& problem, TrajectoryRows rows,
                              std::optional<RowInterpolation> between = {});

}  // namespace corridor
