#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "planner/problem/problem.h"
#include "planner/solve/finish_path.h"
#include "planner/verify/verify_path.h"

namespace corridor::view {

/// A place on a path, and the poses of all frames there.
struct PathSample {
  std::size_t edge = 0;  ///< index: the edge from state `edge` to the next
  double t = 0;          ///< time on the edge, in [0, 1]
  /// The place on the whole path, in [0, 1]. If the path has times, the place is the share of the
  /// duration. Otherwise it grows in proportion to how far the bodies move, so that playing at an
  /// even rate looks even. How far the bodies move between two samples is the largest distance that
  /// a corner of their bounds moves.
  double at = 0;
  std::vector<Transform> X_WF;
};

/// A path for playing. Poses are on Corridor's own edges, and so near to each other that a picture
/// can interpolate linearly between them.
struct PathSamples {
  std::vector<PathSample> samples;
  std::vector<std::size_t> states;    ///< index of the sample of each state of the path
  std::vector<std::size_t> findings;  ///< index of the sample of each finding
};

/// Returns the configuration on an edge at t in [0, 1].
using ConfigurationOnEdge = std::function<Configuration(std::size_t edge, double t)>;

/// Samples a path, or a curve whose pieces are the edges. From one sample to the next no body
/// rotates by more than about 2°, nor moves farther than a 400th of the path. Steps are larger if
/// there would be more than about 1500 samples. All states and findings are samples.
/// @param edges the number of edges. 0: the path is a single state, `at(0, 0)`.
/// @param times the times of all states, seconds; empty: the path has no times.
/// @pre the findings are of that path.
PathSamples samplePath(const Problem& problem, std::size_t edges, const ConfigurationOnEdge& at,
                       const std::vector<double>& times, const std::vector<PathFinding>& findings);
/// Samples a path of edges without times. @pre the path is in the problem's space and not empty.
PathSamples samplePath(const Problem& problem, const Path& path,
                       const std::vector<PathFinding>& findings);

}  // namespace corridor::view
