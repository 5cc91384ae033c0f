#pragma once

#include <optional>
#include <string>

#include "planner/checker/checker.h"

namespace corridor {

/// Returns one line: why the configuration can't be used as a start or goal, and what would help.
/// Returns nullopt if the configuration can be used. For a contact, the line names the two bodies,
/// their triangles, and the nearest free configuration that a search found. For two bodies that are
/// too close, it names the gap, and the setting to change. If two bodies with held joints between
/// them are not free in any state, it names these joints. Up to five other pairs that are not
/// proved free follow.
std::optional<std::string> whyNotFree(const Configuration& q, const Checker& checker);

/// Returns one line: the numbers that are outside of their bounds, and the bounds. If the
/// configuration is the pose of one body, the line has only its position.
/// @pre `q` is out of bounds.
std::string whyOutOfBounds(const Configuration& q, const ConfigurationSpace& space);

}  // namespace corridor
