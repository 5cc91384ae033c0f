#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "collision/core/counters.h"
#include "collision/core/last_pairs.h"
#include "collision/core/swept_ball.h"
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
  /// Two nodes of wide trees, the least key of their boxes' pairs, and which of these are asked
  /// about: bit 4·i + j for a's i-th and b's j-th.
  struct WideItem {
    std::uint32_t a, b;
    float key;
    std::uint32_t pairs;
  };
  std::vector<WideItem> wideStack;
  /// Pairs of nodes of one pair of bodies: a range of `pending`.
  struct PairItems {
    std::uint32_t bodies;
    std::size_t begin, end;
    double clearance = 0;  ///< of what longer windows told apart already, metres; where asked for
  };
  std::vector<WideItem> pending;  ///< what motion queries hand down to shorter windows of time,
  std::vector<PairItems> groups;  ///< and whose it is
  /// Balls around bodies, by their indices in the scene, as the world sees them in the window that
  /// `ballStamp` counts.
  struct StampedBall {
    SweptBall ball;
    std::uint64_t stamp = 0;
  };
  std::vector<StampedBall> balls;
  std::uint64_t ballStamp = 0;
  /// What distance queries have left to look at, and pairs of triangles (in leaf order) that may be
  /// the closest, each with a lower bound of its distance, metres.
  struct BoundedPair {
    std::uint32_t a, b;
    double bound;
  };
  std::vector<BoundedPair> bounded, candidates;
  LastPairs lastPairs;  ///< of wide trees: where their queries look first
};

}  // namespace corridor
