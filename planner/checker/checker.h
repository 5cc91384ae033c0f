#pragma once

#include <memory>
#include <string>
#include <vector>

#include "collision/world/scene.h"
#include "planner/problem/problem.h"

namespace corridor {

/// The bodies of a problem's tested pairs and the others, a shape each, in the problem's order; no
/// tree is built yet.
Scene makeScene(const Problem& problem);

/// What a problem's states and edges are checked for; the plain half of the OMPL classes beside it.
/// Safe to call from many threads at once: each has a QueryContext and an EdgeMotion of its own.
class Checker {
 public:
  /// The problem must outlive the checker. Its bodies are copied. All that the checker asks walks
  /// the trees that `checker: {volume: …}` names.
  /// @throws std::invalid_argument where its words don't go together (`wrongWordIn`).
  explicit Checker(const Problem& problem);
  ~Checker();

  const Problem& problem() const { return problem_; }
  const ConfigurationSpace& space() const { return problem_.space; }
  const Scene& scene() const { return scene_; }
  /// Tolerance and margin that the problem asks for. What is called free keeps the tolerance as a
  /// reserve, which may be undecided anyway: so no returned path hangs on its last digits, and
  /// proving one again takes work in proportion to its length over the tolerance.
  const MotionOptions& options() const { return options_; }
  /// The body of the problem that a shape of the scene belongs to.
  std::size_t bodyOf(std::size_t shape) const { return bodyOf_[shape]; }

  /// Inclusive; what isn't finite, or has a quaternion of zeros, is outside.
  bool inBounds(const Configuration& q) const;
  /// Bounds aside. @pre finite.
  MotionResult state(const Configuration& q) const;
  /// Bounds aside, by the method that the problem asks for (its default where edges are
  /// `discrete`). @pre finite.
  MotionResult edge(const Configuration& from, const Configuration& to, bool earliest) const;
  /// Exact static interference at the rounded poses of the frames: neither margin nor tolerance nor
  /// tube. @pre finite.
  /// @throws std::runtime_error where the processor is set so that no bound holds
  /// (collision/core/floating_point.h); so do `clearance` and `pairsNotFree`.
  std::optional<Contact> interference(const Configuration& q) const;
  /// How far the closest tested pair is apart beyond the margin, metres: where it is 0 or less,
  /// `state` isn't free (it may not be where it is less than tolerance and tube); the margin below
  /// 0 where a pair touches (there is no depth). Infinite where no pair is tested. @pre finite.
  double clearance(const Configuration& q) const;
  /// Two bodies of the problem, by index, of which a state isn't free.
  struct PairNotFree {
    std::size_t a = 0, b = 0;
    bool tooLarge =
        false;  ///< undecided: a value is so large that the pose's rounding hides the gap
  };
  /// The pairs of which `state` isn't free, each once. @pre finite.
  std::vector<PairNotFree> pairsNotFree(const Configuration& q) const;

  /// In bounds and `state` is free.
  bool certifiedState(const Configuration& q) const;
  /// Both ends in bounds (so all of it is), and the edge is free by the default method, whatever
  /// the problem asks for.
  bool certifiedEdge(const Configuration& from, const Configuration& to) const;

  /// Of all threads; call it while no query runs.
  Counters counters() const;

 private:
  struct Workspace;
  class Pool;
  Workspace& mine() const;
  MotionResult edge(const Configuration& from, const Configuration& to, bool earliest,
                    EdgeMethod method) const;

  const Problem& problem_;
  Scene scene_;
  std::vector<std::size_t> bodyOf_;
  MotionOptions options_;
  EdgeMethod method_;
  std::unique_ptr<Pool> pool_;
};

}  // namespace corridor
