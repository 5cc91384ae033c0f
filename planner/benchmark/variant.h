#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "planner/checker/checker.h"

namespace ompl::base {
class SpaceInformation;
class StateValidityChecker;
}  // namespace ompl::base

namespace corridor {

/// Another library's test of states, to compare with; its edges are sampled by OMPL's rule. The
/// program knows none, so as to depend on none: tests/benchmark/plan_benchmark brings FCL.
struct BenchmarkPeer {
  std::string name;
  std::function<std::shared_ptr<ompl::base::StateValidityChecker>(
      const std::shared_ptr<ompl::base::SpaceInformation>&, const Checker&)>
      states;
};

/// A way to check edges, with its knob: what a benchmark compares.
struct Variant {
  std::string name;            ///< as it was asked for: "discrete:0.01"
  std::string edges;           ///< Problem::CheckerSpec::edges
  std::optional<double> knob;  ///< discrete and peers: the resolution; else the tolerance, metres
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
