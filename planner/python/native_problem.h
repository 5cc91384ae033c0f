#pragma once

#include <memory>
#include <mutex>

#include "planner/checker/checker.h"
#include "planner/problem/problem.h"

namespace corridor::python {

/// A problem, and the checker of it, which is made when a query first needs it. Immutable: edits
/// make another NativeProblem. Threads may share it.
class NativeProblem {
 public:
  explicit NativeProblem(Problem problem) : problem_(std::move(problem)) {}
  NativeProblem(const NativeProblem&) = delete;
  NativeProblem& operator=(const NativeProblem&) = delete;

  const Problem& problem() const { return problem_; }
  /// @throws InputError if a mesh of the problem can't be used.
  const Checker& checker() const {
    const std::lock_guard lock(mutex_);
    if (!checker_) checker_ = std::make_unique<Checker>(problem_);
    return *checker_;
  }

 private:
  Problem problem_;
  mutable std::mutex mutex_;
  mutable std::unique_ptr<Checker> checker_;
};

}  // namespace corridor::python
