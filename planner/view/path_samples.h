#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "planner/problem/problem.h"
#include "planner/solve/finish_path.h"
#include "planner/verify/verify_path.h"

namespace corridor::view {

/// A sample of a path: where it is on the path, and the poses of all frames there.
struct PathSample {
  std::size_t edge = 0;  ///< the index of the edge; edge i goes from state i to state i + 1
  double t = 0;          ///< the parameter on the edge, in [0, 1]
  /// The sample's position on the whole path, in [0, 1]. If the path has times, `at` is the elapsed
  /// fraction of the duration. Otherwise, `at` grows from sample to sample in proportion to the
  /// largest distance that a corner of a body's bounds moves. So bodies seem to move evenly if `at`
  /// grows evenly.
  double at = 0;
  std::vector<Transform> X_WF;
};

/// The samples from which a page plays a path. Their poses are computed from Corridor's own edges
/// (or from the curve), and adjacent samples are so near that a page can interpolate linearly
/// between them.
struct PathSamples {
  std::vector<PathSample> samples;
  std::vector<std::size_t> states;    ///< for each state of the path, the index of its sample
  std::vector<std::size_t> findings;  ///< for each finding, the index of its sample
};

/// Returns the configuration on an edge at t in [0, 1].
using ConfigurationOnEdge = std::function<Configuration(std::size_t edge, double t)>;

/// Samples a path, or a curve whose pieces are the edges. From one sample to the next, no body
/// rotates by more than about 2°, and no corner of a body's bounds moves by more than about 1/400
/// of the path's length. If this would need more than about 1500 samples, the steps are larger.
/// There is a sample at each state and at each finding.
/// @param edges the number of edges; 0: the path is a single state. @param at the configurations on
/// the edges; for a single state, `at(0, 0)`.
/// @param times the times of all states, seconds; empty: the path has no times.
/// @pre `findings` are the verifier's findings on this path.
PathSamples samplePath(const Problem& problem, std::size_t edges, const ConfigurationOnEdge& at,
                       const std::vector<double>& times, const std::vector<PathFinding>& findings);
/// Samples a path of edges, without times, by the same rules. @pre The path is in the problem's
/// space and not empty.
PathSamples samplePath(const Problem& problem, const Path& path,
                       const std::vector<PathFinding>& findings);

}  // namespace corridor::view
