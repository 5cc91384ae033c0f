#pragma once

#include <optional>
#include <vector>

#include "planner/checker/checker.h"

namespace corridor::view {

/// The closest of the tested pairs, and its witness points in world coordinates (metres).
struct ClosestPair {
  double distance = 0;       ///< metres; 0: contact
  std::size_t a = 0, b = 0;  ///< bodies of the problem
  Vec3 p_WA = Vec3::Zero(), p_WB = Vec3::Zero();
};

/// Returns the closest tested pair for the poses of all frames, or nullopt if no pair is tested. If
/// several pairs are equally close, any of them may be returned. Cost: pairs are queried in the
/// order of the distances of their bounding spheres, until no other pair can be closer.
std::optional<ClosestPair> closestPair(const Checker& checker, const std::vector<Transform>& X_WF,
                                       QueryContext& context);

}  // namespace corridor::view
