#pragma once

#include "collision/core/counters.h"

namespace corridor {

/// What a query may write: scratch memory, caches and counters of one thread. No answer depends on what it holds.
class QueryContext {
 public:
  Counters counters;
};

}  // namespace corridor
