#pragma once

#include <vector>

#include "collision/core/counters.h"
#include "collision/core/last_pair.h"
#include "collision/core/scratch.h"

namespace corridor {

/// All that a query may write apart from its result. Each thread needs its own context. The
/// context's contents never change a verdict, nor a distance beyond its error bound.
struct QueryContext {
  Counters counters;  ///< the work of all queries since the counters were last cleared
  /// The pairs of triangles that queries of scenes and motions may test first. Entry k belongs to
  /// pair k of the query's bodies. Queries enlarge the list as needed. The entries may influence
  /// the counters, and which of several closest or touching triangles is reported.
  std::vector<LastPair> lastPairs;
  Scratch scratch;

  /// Returns the entry of pair number `pair` of the query's bodies. The reference is valid until a
  /// call with a larger `pair`.
  LastPair& lastPair(std::size_t pair) {
    if (lastPairs.size() <= pair) lastPairs.resize(pair + 1);
    return lastPairs[pair];
  }
};

}  // namespace corridor
