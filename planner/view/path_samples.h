#pragma once

#include <cstddef>
#include <vector>

#include "planner/solve/finish_path.h"
#include "planner/verify/verify_path.h"

namespace corridor::view {

/// A place on a path.
struct PathSample {
  std::size_t edge = 0;  ///< from state `edge` to the next
  double t = 0;          ///< in [0, 1] of the edge
  /// In [0, 1] of the path: how far the moving bodies have gone (the farthest of the corners of
  /// their bounds, added up from sample to sample), so that what is played at an even rate looks
  /// it.
  double at = 0;
  std::vector<Transform> X_WF;
};

/// A path as it is played: poses by Corridor's own edge, so near to each other that between two of
/// them a straight line will do.
struct PathSamples {
  std::vector<PathSample> samples;
  std::vector<std::size_t> states;    ///< the sample of each state of the path
  std::vector<std::size_t> findings;  ///< and of each finding
};

/// From one sample to the next no body turns by more than about 2°, nor goes farther than a 400th
/// of the path; coarser where that would be more than about 1500 samples. All states and findings
/// are samples.
/// @pre a path of the problem's space, not empty; findings of it.
PathSamples samplePath(const Problem& problem, const Path& path,
                       const std::vector<PathFinding>& findings);

}  // namespace corridor::view
