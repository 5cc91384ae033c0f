#pragma once

#include "planner/problem/problem.h"

namespace corridor {

/// Is no pair of bodies tested? Every state and every edge of such a problem counts as free, and
/// every path as proved: a missing obstacle or an `allow` too many looks like success.
bool nothingIsTested(const Problem& problem);

/// The note on that, the first of Problem::notes. Commands say it before anything else.
inline constexpr const char* kNothingTested =
    "no pair of bodies is tested, so nothing can collide and every state counts as free; corridor "
    "inspect --pairs lists the reasons";

}  // namespace corridor
