#pragma once

#include <optional>
#include <string>

#include "planner/checker/checker.h"

namespace corridor {

/// Returns one line: why a start or goal can't be used, and what would help. Returns nullopt if it
/// can be used. For a contact, the line names the two bodies, their triangles, and the nearest free
/// configuration that a search found. For two bodies that are too close, it names the gap, and what
/// to set.
/// @param name for the message: "start", "goal", "goal 1 of 2".
std::optional<std::string> whyNotFree(const std::string& name, const Configuration& q,
                                      const Checker& checker);

}  // namespace corridor
