#pragma once

#include <optional>
#include <vector>

#include "planner/checker/checker.h"

namespace corridor::view {

/// The tested pair that is closest, and its closest points in the world, metres.
struct ClosestPair {
  double distance = 0;       ///< 0: contact
  std::size_t a = 0, b = 0;  ///< bodies of the problem
  Vec3 p_WA = Vec3::Zero(), p_WB = Vec3::Zero();
};

/// Of poses of all frames. Pairs are looked at nearest bounds first, until no other can be closer;
/// of pairs equally close any may be named. None where no pair is tested.
std::optional<ClosestPair> closestPair(const Checker& checker, const std::vector<Transform>& X_WF,
                                       QueryContext& context);

}  // namespace corridor::view
