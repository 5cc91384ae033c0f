#pragma once

#include <cstdint>
#include <vector>

#include "collision/core/counters.h"

namespace corridor {

/// What a query may write: scratch memory and counters of one thread. No answer depends on what it
/// holds.
class QueryContext {
 public:
  Counters counters;

  /// A pair of tree nodes, of the pair of bodies numbered `bodies` where several share a list.
  struct NodePair {
    std::uint32_t a, b, bodies;
  };
  std::vector<NodePair> stack;  ///< of the traversal under way
  std::vector<NodePair> pending,
      next;  ///< what motion queries hand down to shorter windows of time
};

}  // namespace corridor
