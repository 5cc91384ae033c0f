#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "collision/core/counters.h"
#include "collision/core/last_pairs.h"
#include "collision/core/transform.h"

namespace corridor {

/// What a query may write: scratch memory, counters and guesses of one thread. No verdict depends
/// on what it holds, and no distance beyond the error that it may have; which of several triangles
/// are named for it may.
class QueryContext {
 public:
  Counters counters;

  /// A pair of tree nodes, of the pair of bodies numbered `bodies` where several share a list.
  struct NodePair {
    std::uint32_t a, b, bodies;
  };
  std::vector<NodePair> stack;  ///< of the traversal under way
  /// Two nodes of wide trees, the least key of their boxes' pairs, and which of their boxes are
  /// asked about (a's four bits above b's).
  struct WideItem {
    std::uint32_t a, b;
    float key;
    std::uint32_t masks;
  };
  std::vector<WideItem> wideStack;
  std::vector<NodePair> pending,
      next;  ///< what motion queries hand down to shorter windows of time
  /// What distance queries have left to look at, and pairs of triangles (in leaf order) that may be
  /// the closest, each with a lower bound of its distance, metres.
  struct BoundedPair {
    std::uint32_t a, b;
    double bound;
  };
  std::vector<BoundedPair> bounded, candidates;
  /// Motions that the window of time under way has asked for, and their maps at its middle.
  struct Posed {
    std::size_t motion;
    Transform X_AB;
  };
  std::vector<Posed> posed;
  LastPairs lastPairs;  ///< of wide trees: where their queries look first
};

}  // namespace corridor
