#pragma once

#include <optional>
#include <string>

#include "planner/checker/checker.h"

namespace corridor {

/// Why a start or goal can't be used, as one line that says what would help: which pair touches, in
/// which triangles, how far and where the next free position is; or which pair is too close and
/// what to set. nullopt if it can.
/// @param name "start", "goal".
std::optional<std::string> whyNotFree(const std::string& name, const Configuration& q,
                                      const Checker& checker);

}  // namespace corridor
