#pragma once

#include "planner/problem/problem.h"

namespace corridor {

/// Returns whether no pair of bodies of the problem is tested. If so, every state and edge counts
/// as free, and every path counts as proved. A missing obstacle or a wrong `allow` would then look
/// like success.
bool nothingIsTested(const Problem& problem);

/// The note for a problem without tested pairs. This note is the first of Source::notes, and
/// commands print it before any other output.
inline constexpr const char* kNothingTested =
    "no pair of bodies is tested, so nothing can collide and every state counts as free; corridor "
    "inspect --pairs lists the reasons";

}  // namespace corridor
