#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "planner/checker/checker.h"
#include "planner/problem/yaml_value.h"

namespace ompl::base {
class MotionValidator;
class SpaceInformation;
class StateValidityChecker;
}  // namespace ompl::base

namespace corridor {

struct BenchmarkRun;

/// Another test of states, of edges, or of both, to compare with.
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
  std::string version = {};  ///< "FCL 0.7.0"
};

/// A checker, as a benchmark compares it with others.
struct Variant {
  std::string name;
  /// A map: what it sets of a problem's `checker:`, read without a fault (`readCheckerKeys`).
  YamlValue checker;
  std::optional<BenchmarkPeer> peer;

  /// A problem's checker, changed to this one: what it doesn't set stays the problem's.
  /// @throws InputError where the two don't go together (an overlap test of another volume).
  void apply(Problem::CheckerSpec& checker) const;
};

/// A map for `Variant::checker`. @pre the values are legal ones of these keys.
YamlValue checkerMap(const std::vector<std::pair<std::string, std::string>>& keys);

/// NAME or NAME:KNOB, where NAME is a value of `checker: {edges: …}` or a peer's; the knob is, of
/// one that samples, its resolution (OMPL's longest_valid_segment_fraction), else the tolerance in
/// metres. @throws InputError: unknown name (lists what there is), a knob that is no number or out
/// of range (a resolution from 1e-9 to below 1, a tolerance above 0).
Variant readVariant(const std::string& text, const std::vector<BenchmarkPeer>& peers = {});

}  // namespace corridor
