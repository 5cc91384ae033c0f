#pragma once

#include <string>

#include "collision/core/error.h"
#include "planner/solve/solve.h"

namespace corridor::test {

/// Returns the faults for which a problem is refused; "" if it is not refused.
inline std::string complaintOf(const Problem& problem, const SolveOptions& options = {}) {
  try {
    solveProblem(problem, options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace corridor::test
