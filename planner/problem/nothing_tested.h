#pragma once

#include "planner/problem/problem.h"

namespace corridor {

/// Returns whether no pair of bodies is tested. Every state and edge of such a problem counts as
/// free, and every path as proved, so that a missing obstacle or a wrong `allow` looks like
/// success.
bool nothingIsTested(const Problem& problem);

/// The note on such a problem, the first of Source::notes. Commands print it before any other
/// output.
inline constexpr const char* kNothingTested =
    "no pair of bodies is tested, so nothing can collide and every state counts as free; corridor "
    "inspect --pairs lists the reasons";

}  // namespace corridor
