#include "planner/problem/nothing_tested.h"

namespace corridor {

bool nothingIsTested(const Problem& problem) {
  bool nothing = true;
  forEachTestedPair(problem.model, [&](std::size_t, std::size_t) { nothing = false; });
  return nothing;
}

}  // namespace corridor
