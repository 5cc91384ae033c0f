#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "planner/checker/checker.h"
#include "planner/problem/problem.h"
#include "planner/problem/yaml_value.h"

namespace ompl::base {
class MotionValidator;
class SpaceInformation;
class StateValidityChecker;
}  // namespace ompl::base

namespace corridor {

struct BenchmarkRun;

/// A competitor: another test of states, of edges, or of both, to compare with Corridor's.
struct BenchmarkCompetitor {
  template <class Made>
  using Make = std::function<std::shared_ptr<Made>(
      const std::shared_ptr<ompl::base::SpaceInformation>&, const Checker&)>;

  std::string name;
  Make<ompl::base::StateValidityChecker> states;  ///< null: Corridor's test of states for `edges`
  Make<ompl::base::MotionValidator> motions = nullptr;  ///< null: Corridor's test for `edges`
  /// The value of `checker: {edges: …}` with which the competitor runs. With "discrete", edges are
  /// sampled by OMPL's rule, and `states` tests the samples.
  std::string edges = "discrete";
  /// Makes a whole run in place of runUnderOmpl, in a process of its own. Null: runUnderOmpl makes
  /// the run. If the function throws, the run fails with the exception's text.
  std::function<BenchmarkRun(const Problem& planned, double memory,
                             std::vector<Configuration>& path)>
      run = nullptr;
  std::string version = {};  ///< for reports: "FCL 0.7.0"
};

/// A checker that a benchmark compares with others.
struct Variant {
  std::string name;
  /// The keys that the variant sets in a problem's `checker:`, as a map that `readCheckerKeys`
  /// reads without a fault.
  YamlValue checker;
  std::optional<BenchmarkCompetitor> competitor;

  /// Applies the variant to a problem's checker: keys that the variant doesn't set keep the
  /// problem's values.
  /// @throws InputError if the two don't go together (an overlap test of another volume).
  void apply(CheckerSettings& checker) const;
};

/// Returns a map for `Variant::checker`. @pre the values are legal for these keys.
YamlValue checkerMap(const std::vector<std::pair<std::string, std::string>>& keys);

/// Reads NAME or NAME:KNOB, where NAME is a value of `checker: {edges: …}` or a competitor's name.
/// For variants that sample edges, KNOB is the resolution (OMPL's longest_valid_segment_fraction);
/// for all other variants, it is the tolerance in metres.
/// @throws InputError for an unknown name (the message lists the known names), and for a KNOB that
/// is not legal: a resolution must fulfil isResolution, a tolerance must be above 0.
Variant readVariant(const std::string& text,
                    const std::vector<BenchmarkCompetitor>& competitors = {});

}  // namespace corridor
