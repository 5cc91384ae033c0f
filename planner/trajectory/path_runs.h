#pragma once

#include <cstddef>
#include <vector>

#include "planner/trajectory/path_view.h"

namespace corridor {

/// A run: consecutive pieces of a path that a time law can pass through without a stop. The path
/// parameter s of the run starts at 0; each piece has ds/dτ = its `length`, so that dq/ds is
/// continuous.
struct PathRun {
  struct Part {
    std::size_t piece = 0;
    double length = 0;  ///< > 0
  };
  std::vector<Part> parts;
  /// Whether dq/ds is 0 and d²q/ds² is not 0, at the start or at the end of the run. Then the robot
  /// is at rest there, whatever ṡ is; so ṡ need not be 0 there.
  bool restsAtStart = false, restsAtEnd = false;
};

/// Returns the runs of a path. The path is split where the direction of its tangent jumps by more
/// than `cornerAngle` radians, and where its tangent is 0. Pieces without length are left out.
/// @param smooth true: the path is also split where the second derivative d²q/ds² jumps.
std::vector<PathRun> runsOf(const PathView& view, double cornerAngle, bool smooth);

/// Returns s at the start of each part of a run, and at the end of the run.
std::vector<double> beginsOf(const PathRun& run);

}  // namespace corridor
