#include "planner/problem/nothing_tested.h"

namespace corridor {

bool nothingIsTested(const Problem& problem) {
  bool nothing = true;
  const Required need = requiredBy(problem.task);
  forEachTestedPair(problem.model, need, [&](std::size_t, std::size_t) { nothing = false; });
  return nothing;
}

}  // namespace corridor
