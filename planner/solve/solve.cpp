#include "planner/solve/solve.h"

#include "planner/solve/solve_run.h"

namespace corridor {

void checkSettings(const Problem& problem) {
  const SolveOptions options;
  SolveRun(problem, options).setUp();
}

const char* nameOf(SolveOutcome outcome) {
  switch (outcome) {
    case SolveOutcome::solved:
      return "solved";
    case SolveOutcome::notFound:
      return "not found";
    case SolveOutcome::approximate:
      return "approximate only";
    case SolveOutcome::interrupted:
      return "interrupted";
  }
  return "";
}

SolveReport solveProblem(const Problem& problem, const SolveOptions& options) {
  SolveRun solve(problem, options);
  solve.setUp();  // before start and goals are tested: wrong names are reported at once
  solve.setUpEnds();
  solve.plan(ompl::base::plannerNonTerminatingCondition());
  return solve.report();
}

}  // namespace corridor
