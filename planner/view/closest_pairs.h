#pragma once

#include <optional>
#include <vector>

#include "planner/checker/checker.h"

namespace corridor::view {

/// The closest of the tested pairs of bodies, and its witness points in world coordinates (metres).
struct ClosestPair {
  double distance = 0;       ///< metres; 0: contact
  std::size_t a = 0, b = 0;  ///< indices of the problem's bodies
  Vec3 p_WA = Vec3::Zero(), p_WB = Vec3::Zero();
};

/// Returns the closest tested pair of bodies for these poses of all frames, or nullopt if no pair
/// is tested. If several pairs are equally close, any of them may be returned. Cost: pairs are
/// queried in ascending order of the distances between their bounding spheres, until no other pair
/// can be closer.
std::optional<ClosestPair> closestPair(const Checker& checker, const std::vector<Transform>& X_WF,
                                       QueryContext& context);

}  // namespace corridor::view
