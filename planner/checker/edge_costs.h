#pragma once

#include <cstdint>
#include <vector>

#include "planner/checker/checker.h"

namespace corridor {

/// The times to certify a sample of a model's edges, and the fraction of the time that each pair of
/// bodies takes.
struct EdgeCosts {
  std::size_t edges = 0, free = 0;  ///< numbers of tested edges, and of free ones among them
  /// Median times of the free edges, and of the others; 0 if there are no such edges.
  double freeSeconds = 0, otherSeconds = 0;
  struct OfPair {
    std::size_t a = 0, b = 0;  ///< bodies of the model
    double share = 0;  ///< time of the pair, as a fraction of the summed times of all pairs, each
                       ///< certified alone
    std::uint64_t boxTests = 0, primitiveTests = 0;  ///< over all edges
  };
  std::vector<OfPair> pairs;  ///< all tested pairs, the most expensive first
};

/// Certifies random edges. Each edge begins at a random state within the bounds and goes a fifth of
/// the way to another one. Planners with OMPL's default range have edges of a similar length. The
/// result is for display only: times depend on the machine and its load.
/// @param edges the maximum number of edges to certify. If it is not 0, at least one edge is
/// certified, however small `seconds` is.
/// @param seconds time after which no further edge is begun.
EdgeCosts sampleEdgeCosts(const Checker& checker, std::size_t edges, double seconds,
                          std::uint64_t seed);

}  // namespace corridor
