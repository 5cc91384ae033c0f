#pragma once

#include <string>
#include <vector>

#include "planner/solve/solution.h"
#include "planner/verify/verify_path.h"

namespace corridor {

/// The second opinion on a solution of a problem.
struct VerifyReport {
  PathVerdict verdict = PathVerdict::proved;
  PathReport motion;  ///< of the path among the meshes, by planner/verify alone
  std::vector<std::string>
      violations;           ///< what else is wrong, one line each: start, goal, bounds of a state
  bool reachesGoal = true;  ///< the last state is in the goal
  double margin = 0;        ///< metres
  Configuration tube;       ///< that was proved, as Problem::tube
};

/// A problem as planner/verify wants it. The problem must outlive it.
PathProblem plainProblem(const Problem& problem);

/// Checks that the path starts at the start, ends in the goal, stays in the bounds, and (by
/// planner/verify) that every curve in the problem's tube around it keeps the problem's margin.
/// Shares neither bounds, poses nor trees with the checker
/// that planned it.
VerifyReport verifySolution(const Problem& problem, const Solution& solution);

}  // namespace corridor
