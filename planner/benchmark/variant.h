#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "planner/checker/checker.h"

namespace ompl::base {
class MotionValidator;
class SpaceInformation;
class StateValidityChecker;
}  // namespace ompl::base

namespace corridor {

struct BenchmarkRun;

/// Another test of states, of edges, or of both, to compare with. The program knows none, so as to
/// depend on none: tests/benchmark/plan_benchmark brings FCL, and answers that were recorded.
struct BenchmarkPeer {
  template <class Made>
  using Make = std::function<std::shared_ptr<Made>(
      const std::shared_ptr<ompl::base::SpaceInformation>&, const Checker&)>;

  std::string name;
  Make<ompl::base::StateValidityChecker> states;        ///< null: as by `edges`
  Make<ompl::base::MotionValidator> motions = nullptr;  ///< null: as by `edges`
  /// Of checker.edges, what the peer takes the place of. By "discrete", edges are sampled by OMPL's
  /// rule, and `states` is asked.
  std::string edges = "discrete";
  /// Makes a run, where there is more to do than runUnderOmpl, and as that. It has a process of its
  /// own. @throws what becomes the run's failure.
  std::function<BenchmarkRun(const Problem& planned, double memory,
                             std::vector<Configuration>& path)>
      run = nullptr;
};

/// A way to check edges, with its knob: what a benchmark compares.
struct Variant {
  std::string name;            ///< as it was asked for: "discrete:0.01"
  std::string edges;           ///< Problem::CheckerSpec::edges
  std::optional<double> knob;  ///< of one that samples, the resolution; else the tolerance, metres
  std::optional<BenchmarkPeer> peer;

  /// Whether the knob is a resolution (OMPL's longest_valid_segment_fraction).
  bool samples() const { return edges == "discrete"; }
  /// A problem's checker, changed to this one. Without a knob, the problem's own stays.
  void apply(Problem::CheckerSpec& checker) const;
};

/// NAME or NAME:KNOB, where NAME is a value of `checker: {edges: …}` or a peer's.
/// @throws InputError: unknown name (lists what there is), a knob that is no number or out of range
/// (a resolution from 1e-9 to below 1, a tolerance above 0).
Variant readVariant(const std::string& text, const std::vector<BenchmarkPeer>& peers = {});

}  // namespace corridor
