#pragma once

#include <cstddef>
#include <vector>

#include "planner/trajectory/path_view.h"

namespace corridor {

/// Consecutive pieces that a law can pass through without a stop. The path parameter s of the run
/// starts at 0; each piece has ds/dτ = its `length`, so that dq/ds is continuous.
struct PathRun {
  struct Part {
    std::size_t piece = 0;
    double length = 0;  ///< > 0
  };
  std::vector<Part> parts;
  /// Whether dq/ds is 0 at the start (end) of the run, and d²q/ds² is not. Then the robot is at
  /// rest there whatever ṡ is, so ṡ need not be 0.
  bool restsAtStart = false, restsAtEnd = false;
};

/// Splits a path where its tangent jumps by more than `cornerAngle` radians, or is 0.
/// @param smooth also splits it where the second derivative d²q/ds² jumps.
std::vector<PathRun> runsOf(const PathView& view, double cornerAngle, bool smooth);

/// Returns s at the start of each part of a run, and at its end.
std::vector<double> beginsOf(const PathRun& run);

}  // namespace corridor
