#pragma once

#include <cstdint>
#include <vector>

#include "planner/checker/checker.h"

namespace corridor {

/// Where the time of a problem's edges goes, as a sample of them tells it.
struct EdgeCosts {
  std::size_t edges = 0, free = 0;           ///< looked at; free of them
  double freeSeconds = 0, otherSeconds = 0;  ///< medians of an edge; 0 where there is none
  struct OfPair {
    std::size_t a = 0, b = 0;                       ///< bodies of the problem
    double share = 0;                               ///< of the time of all pairs, each by itself
    std::uint64_t boxTests = 0, triangleTests = 0;  ///< of all edges
  };
  std::vector<OfPair> pairs;  ///< those that take any time, the dearest first
};

/// Certifies random edges: from a random state within the bounds a fifth of the way to another, as
/// planners with OMPL's usual range do. For people: times are the machine's of the moment.
/// @param edges,seconds at most so many, and none more after so long; one at least.
EdgeCosts sampleEdgeCosts(const Problem& problem, const Checker& checker, std::size_t edges,
                          double seconds, std::uint64_t seed);

}  // namespace corridor
