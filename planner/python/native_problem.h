#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "planner/checker/checker.h"
#include "planner/problem/problem.h"

namespace corridor::python {

/// The values of corridor.Verdict.
enum Code : std::int8_t { kFree = 0, kContact = 1, kUndecided = 2, kOutOfBounds = 3 };

inline Code codeOf(bool inBounds, MotionVerdict verdict) {
  if (!inBounds) return kOutOfBounds;
  return verdict == MotionVerdict::free      ? kFree
         : verdict == MotionVerdict::contact ? kContact
                                             : kUndecided;
}

/// A problem and its checker. The checker is made when a query first needs it. The object is
/// immutable: an edit makes another NativeProblem. Several threads may use the object at once.
class NativeProblem {
 public:
  /// @param origins see SolveOptions::valueOrigins.
  /// @param earlier a problem with equal meshes and settings of trees, whose trees are used, too;
  /// may be null.
  explicit NativeProblem(Problem problem, std::map<std::string, std::string> origins = {},
                         std::shared_ptr<const NativeProblem> earlier = {})
      : problem_(std::move(problem)), origins_(std::move(origins)), earlier_(std::move(earlier)) {}
  NativeProblem(const NativeProblem&) = delete;
  NativeProblem& operator=(const NativeProblem&) = delete;

  const Problem& problem() const { return problem_; }
  const std::map<std::string, std::string>& origins() const { return origins_; }
  /// @throws InputError if a mesh of the problem can't be used.
  const Checker& checker() const {
    const std::lock_guard lock(mutex_);
    if (!checker_) checker_ = std::make_unique<Checker>(problem_, earlierScene());
    earlier_.reset();
    return *checker_;
  }

 private:
  /// Returns the scene of the nearest earlier problem that has a checker; null if there is none.
  const Scene* earlierScene() const {
    for (const NativeProblem* each = earlier_.get(); each; each = each->earlier_.get())
      if (each->checker_) return &each->checker_->scene();
    return nullptr;
  }

  Problem problem_;
  std::map<std::string, std::string> origins_;
  mutable std::mutex mutex_;
  mutable std::shared_ptr<const NativeProblem> earlier_;  // until the checker is made
  mutable std::unique_ptr<Checker> checker_;
};

}  // namespace corridor::python
