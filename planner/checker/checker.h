#pragma once

#include <memory>
#include <string>
#include <vector>

#include "collision/world/scene.h"
#include "planner/problem/problem.h"

namespace corridor {

/// Returns the scene of a problem: one body per shape of all the problem's bodies, in the problem's
/// order, and the pairs that the problem tests. Builds no tree.
Scene makeScene(const Problem& problem);

/// Checks states and edges of a problem. The OMPL classes in this folder forward to it.
///
/// Thread safety: all functions may be called from several threads at once, except `counters`. Each
/// thread has its own QueryContext and EdgeMotion.
class Checker {
 public:
  /// The problem must outlive the checker; its bodies are copied. All queries use the trees that
  /// `checker: {volume: …}` names.
  /// @throws std::invalid_argument if the words under `checker` don't go together
  /// (`invalidNameIn`).
  explicit Checker(const Problem& problem);
  ~Checker();

  const Problem& problem() const { return problem_; }
  const ConfigurationSpace& space() const { return problem_.space; }
  const Scene& scene() const { return scene_; }
  /// The tolerance and margin of the problem. The clearance slack is the tolerance: `free` requires
  /// a clearance of margin plus tolerance. With less clearance the verdict may be `undecided`
  /// anyway. So no returned path depends on the last digits of a clearance. The work to prove a
  /// path again is at most proportional to its length divided by the tolerance.
  const MotionOptions& options() const { return options_; }
  /// Returns the body of the problem that a shape of the scene belongs to.
  std::size_t bodyOf(std::size_t shape) const { return bodyOf_[shape]; }

  /// Tests the bounds, which are inclusive. A configuration that is not finite or has a zero
  /// quaternion is out of bounds.
  bool inBounds(const Configuration& q) const;
  /// Proves a state free, as an edge of zero length. Doesn't test the bounds. @pre finite.
  MotionResult state(const Configuration& q) const;
  /// Proves an edge free with the problem's method (for `discrete`, with the default method).
  /// Doesn't test the bounds. @pre finite.
  MotionResult edge(const Configuration& from, const Configuration& to, bool earliest) const;
  /// Tests the rounded poses of the frames for contact, exactly. Margin, tolerance and tube are
  /// ignored. @pre finite.
  /// @throws std::runtime_error if the processor's floating-point mode makes the bounds invalid
  /// (collision/core/floating_point.h). So do `clearance` and `pairsNotFree`.
  std::optional<Contact> interference(const Configuration& q) const;
  /// Returns the smallest distance of the tested pairs less the margin, metres. If it is 0 or less,
  /// `state` is not `free`; below tolerance plus tube, `state` may be undecided. If a pair touches,
  /// the result is 0 − margin, since no penetration depth is computed. Infinite if no pair is
  /// tested. @pre finite.
  double clearance(const Configuration& q) const;
  /// Two bodies of the problem, by index, for which a state is not free.
  struct PairNotFree {
    std::size_t a = 0, b = 0;
    bool tooLarge = false;  ///< undecided, as the rounding of a large value hides the gap
  };
  /// Returns all pairs of bodies for which `state` is not free, each once. @pre finite.
  std::vector<PairNotFree> pairsNotFree(const Configuration& q) const;

  /// Returns whether q is in bounds and `state` is `free`.
  bool certifiedState(const Configuration& q) const;
  /// Returns whether both ends are in bounds (then the whole edge is) and the edge is proved free
  /// by the default method. The problem's method is ignored.
  bool certifiedEdge(const Configuration& from, const Configuration& to) const;

  /// Returns the sum over all threads. Call it while no query runs.
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
