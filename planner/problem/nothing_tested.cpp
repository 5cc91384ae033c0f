#include "planner/problem/nothing_tested.h"

#include <algorithm>

namespace corridor {

bool nothingIsTested(const Problem& problem) {
  return std::none_of(problem.pairs.begin(), problem.pairs.end(),
                      [](const ProblemPair& pair) { return pair.skipped.empty(); });
}

}  // namespace corridor
