#pragma once

#include "planner/problem/problem.h"

namespace corridor {

/// Returns true if no pair of bodies of the problem is tested. Then every state and edge counts as
/// free, and every path counts as proved. So a missing obstacle or a wrong `allow` would look like
/// success.
bool nothingIsTested(const Problem& problem);

/// The note for a problem without tested pairs. This note is the first of Source::notes, and
/// commands print it before any other output.
inline constexpr const char* kNothingTested =
    "no pair of bodies is tested, so nothing can collide and every state counts as free; corridor "
    "inspect --pairs lists the reasons";

}  // namespace corridor
