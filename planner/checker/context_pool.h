#pragma once

#include <memory>
#include <mutex>
#include <thread>
#include <unordered_map>

#include "collision/core/query_context.h"

namespace corridor {

/// One QueryContext a thread, made when a thread first asks. No state outlives the pool.
class ContextPool {
 public:
  /// The calling thread's own. The reference stays good as long as the pool.
  QueryContext& mine();
  /// Sum over all threads. Call it while no query runs.
  Counters total() const;

 private:
  mutable std::mutex mutex_;
  std::unordered_map<std::thread::id, std::unique_ptr<QueryContext>> contexts_;
};

}  // namespace corridor
