#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

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
  explicit NativeProblem(Problem problem, std::map<std::string, std::string> origins = {})
      : problem_(std::move(problem)), origins_(std::move(origins)) {}
  /// Makes an edited problem, with the same meshes and settings of trees where they are the same:
  /// it uses the trees that `from` has.
  /// @param base the problem before its obstacles were replaced; null if they are its own.
  NativeProblem(Problem problem, std::map<std::string, std::string> origins,
                const NativeProblem& from, std::shared_ptr<const NativeProblem> base)
      : problem_(std::move(problem)),
        origins_(std::move(origins)),
        base_(std::move(base)),
        meshes_(from.meshes()) {}
  NativeProblem(const NativeProblem&) = delete;
  NativeProblem& operator=(const NativeProblem&) = delete;

  const Problem& problem() const { return problem_; }
  const std::map<std::string, std::string>& origins() const { return origins_; }
  const std::shared_ptr<const NativeProblem>& base() const { return base_; }
  /// @throws InputError if a mesh of the problem can't be used.
  const Checker& checker() const {
    const std::lock_guard lock(mutex_);
    if (!checker_) checker_ = std::make_unique<Checker>(problem_, meshes_);
    meshes_.clear();  // the checker has those that it uses
    return *checker_;
  }
  /// Returns bodies of all meshes of the problem, which share the trees that exist or will be
  /// built.
  /// @throws InputError if a mesh of the problem can't be used.
  std::vector<Body> ownMeshes() const {
    {
      const std::lock_guard lock(mutex_);
      if (!checker_) {
        const CheckerOptions options = checkerOptions(problem_.task, problem_.settings.checker);
        const Scene scene =
            makeScene(problem_.model, requiredBy(problem_.task), options.trees.params, meshes_);
        meshes_ = meshesOf(scene);
      }
    }
    return meshes();
  }
  /// Returns the meshes of the checker, or if there is none yet, those of earlier problems, with
  /// their trees. They share the trees.
  std::vector<Body> meshes() const {
    const std::lock_guard lock(mutex_);
    if (checker_) return meshesOf(checker_->scene());
    std::vector<Body> meshes;
    for (const Body& body : meshes_) meshes.push_back(body.renamed(body.name()));
    return meshes;
  }

 private:
  static std::vector<Body> meshesOf(const Scene& scene) {
    std::vector<Body> meshes;
    for (const Scene::Placed& placed : scene.bodies())
      if (placed.body.isMesh()) meshes.push_back(placed.body.renamed(placed.body.name()));
    return meshes;
  }

  Problem problem_;
  std::map<std::string, std::string> origins_;
  std::shared_ptr<const NativeProblem> base_;
  mutable std::mutex mutex_;          // held for the members below
  mutable std::vector<Body> meshes_;  // of earlier problems, until the checker is made
  mutable std::unique_ptr<Checker> checker_;
};

}  // namespace corridor::python
