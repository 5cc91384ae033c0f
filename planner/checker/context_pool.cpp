#include "planner/checker/context_pool.h"

namespace corridor {

QueryContext& ContextPool::mine() {
  const std::lock_guard lock(mutex_);
  std::unique_ptr<QueryContext>& context = contexts_[std::this_thread::get_id()];
  if (!context) context = std::make_unique<QueryContext>();
  return *context;
}

Counters ContextPool::total() const {
  const std::lock_guard lock(mutex_);
  Counters sum;
  for (const auto& [thread, context] : contexts_) sum += context->counters;
  return sum;
}

}  // namespace corridor
