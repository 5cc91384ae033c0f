#pragma once

#include <string>
#include <vector>

#include "planner/solve/solution.h"
#include "planner/verify/verify_path.h"

namespace corridor {

/// What a solution's digest says of the files that it was made for.
enum class DigestState {
  same,     ///< they are the problem's
  differs,  ///< the problem or one of its files has changed since, or it is another one
  none      ///< nothing: written by hand, or a `.path` file
};
const char* nameOf(DigestState state);
DigestState digestState(const Problem& problem, const Solution& solution);

/// What to do with a solution whose digest differs from the problem's.
enum class OtherDigest {
  refused,  ///< it is not verified: a proof for this problem is no proof for the solution's own
  ignored
};

/// The second opinion on a solution of a problem.
struct VerifyReport {
  PathVerdict verdict = PathVerdict::proved;
  DigestState digest = DigestState::none;
  /// The digest differs and was not ignored: nothing was verified, and `verdict` is `undecided`.
  bool otherProblem = false;
  PathReport motion;  ///< of the path among the meshes, by planner/verify alone
  std::vector<std::string>
      violations;           ///< what else is wrong, one line each: start, goal, bounds of a state
  bool reachesGoal = true;  ///< the last state is in the goal
  double margin = 0;        ///< metres
  Configuration tube;       ///< that was proved, as Problem::tube
};

const char* nameOf(PathVerdict verdict);
/// "proved", "refuted", "undecided", or "other problem".
const char* verdictName(const VerifyReport& report);

/// A problem as planner/verify wants it. The problem must outlive it.
PathProblem plainProblem(const Problem& problem);

/// Checks that the path starts at the start, ends in the goal, stays in the bounds, and (by
/// planner/verify) that every curve in the problem's tube around it keeps the problem's margin.
/// Shares neither bounds, poses nor trees with the checker
/// that planned it.
VerifyReport verifySolution(const Problem& problem, const Solution& solution,
                            OtherDigest other = OtherDigest::refused);

}  // namespace corridor
