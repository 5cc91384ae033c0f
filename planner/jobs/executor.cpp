#include "planner/jobs/executor.h"

#include <system_error>
#include <utility>

namespace corridor {

LocalExecutor::LocalExecutor(std::size_t places, TaskStarter starter, Killable killable)
    : places_(places), starter_(std::move(starter)), killable_(killable) {}

bool LocalExecutor::start(std::uint64_t task) {
  while (!idle_.empty()) {
    std::unique_ptr<ChildProcess> child = std::move(idle_.back());
    idle_.pop_back();
    if (!child->begin(task)) continue;
    running_.push_back({task, std::move(child)});
    return true;
  }
  try {
    running_.push_back({task, std::make_unique<ChildProcess>(starter_(task))});
  } catch (const std::system_error&) {
    if (running_.empty()) throw;
    return false;
  }
  return true;
}

std::vector<TaskEnd> LocalExecutor::wait(int milliseconds) {
  std::vector<ChildProcess*> children;
  for (const Running& one : running_) children.push_back(one.child.get());
  ChildProcess::waitForAny(children, milliseconds);
  std::vector<TaskEnd> ends;
  for (Running& one : running_) {
    if (!one.child->poll()) continue;
    ends.push_back({one.task, one.child->end()});
    std::vector<std::string>& messages = ends.back().end.messages;
    for (std::size_t i = 0; i + 1 < messages.size(); ++i) messages[i].clear();
    if (one.child->over())
      one.child.reset();
    else
      idle_.push_back(std::move(one.child));
  }
  std::erase_if(running_, [](const Running& one) { return !one.child; });
  return ends;
}

std::vector<std::uint64_t> LocalExecutor::stop() {
  std::vector<std::uint64_t> killed;
  std::erase_if(running_, [&](const Running& one) {
    if (killable_ == Killable::untilItSends && one.child->hasSent()) return false;
    one.child->stop("interrupted");
    killed.push_back(one.task);
    return true;
  });
  return killed;
}

}  // namespace corridor
