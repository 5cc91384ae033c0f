#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "collision/hierarchy/tree_kinds.h"
#include "collision/motion/edge_method.h"

namespace corridor {

/// OMPL's samplers of valid states, which are the classes …ValidStateSampler.
enum class ValidSampler { uniform, gaussian, obstacleBased, bridgeTest, maxClearance };
/// The objectives that planners can optimise.
enum class Objective { length, maxMinClearance, mechanicalWork };

/// How a path is shortened: by Corridor's simplifier (solve/simplify_path.h), not at all, or by
/// OMPL's `PathSimplifier::simplify`, as a baseline.
enum class Simplifier { corridor, none, ompl };

/// How the curve of a trajectory is made from a path: without smoothing (the robot stops at every
/// corner), by rounding its corners only, or as a whole, with the least time, length or
/// acceleration (solve/curve_measure.h).
enum class Smoothing { none, corners, time, length, acceleration };

/// What keeps the preferred clearance: the path, and a trajectory along it; or only the path.
enum class ClearanceOf { trajectory, path };

/// Returns the words that users write for the enumerators of a choice, in the order of the
/// enumeration.
/// @tparam Choice EdgeMethod, ValidSampler, Objective, Simplifier, Smoothing or ClearanceOf.
template <class Choice>
const std::vector<std::string>& wordsFor();
template <>
const std::vector<std::string>& wordsFor<EdgeMethod>();
template <>
const std::vector<std::string>& wordsFor<ValidSampler>();
template <>
const std::vector<std::string>& wordsFor<Objective>();
template <>
const std::vector<std::string>& wordsFor<Simplifier>();
template <>
const std::vector<std::string>& wordsFor<Smoothing>();
template <>
const std::vector<std::string>& wordsFor<ClearanceOf>();

/// Returns the word that users write for an enumerator.
template <class Choice>
const std::string& wordOf(Choice choice) {
  return wordsFor<Choice>()[static_cast<std::size_t>(choice)];
}

/// Returns the enumerator that a word stands for, or nullopt for an unknown word.
template <class Choice>
std::optional<Choice> choiceNamed(std::string_view word) {
  const std::vector<std::string>& words = wordsFor<Choice>();
  for (std::size_t i = 0; i < words.size(); ++i)
    if (words[i] == word) return static_cast<Choice>(i);
  return std::nullopt;
}

/// The smallest legal resolution of sampled edges. A smaller resolution has no use, and OMPL counts
/// the steps of an edge in 32 bits.
inline constexpr double kFinestResolution = 1e-9;
/// Returns whether a value is legal as OMPL's longest_valid_segment_fraction: from
/// `kFinestResolution` to below 1.
inline bool isResolution(double value) {
  return kFinestResolution <= value && value < 1;
}

struct PlannerSettings {
  std::string name = "RRTConnect";  ///< OMPL's name of the planner
  double time = 20;                 ///< seconds
  /// Whether to stop at the first solution. Unset: planners that optimise use all the time, and the
  /// others stop at the first solution.
  std::optional<bool> stopAtFirst;
  /// The number of edges after which the search starts again, with other random numbers. Each
  /// search may test twice as many edges as the one before. 0: it never starts again. The search of
  /// a planner that uses all its time never starts again, whatever this number is. Unset: see
  /// `SolveRun::defaultRestart`.
  std::optional<std::uint64_t> restart;
  std::map<std::string, std::string> params;  ///< values as text, by OMPL's names of the parameters
};

struct CheckerSettings {
  EdgeMethod edges = EdgeMethod::certified;
  double resolution = 0.01;         ///< for `discrete`; see isResolution
  std::optional<double> tolerance;  ///< metres; unset: see checker/default_tolerance.h
  /// The trees that queries walk, by the words that users write.
  TreeNames trees = {"obb", "", "", ""};
};

/// Preferences for paths. A path follows them where possible, but must always keep margin, padding
/// and tube.
struct PreferSettings {
  /// Metres that the two bodies of each tested pair should keep apart (solve/clearance_targets.h);
  /// 0: as close as the shortest path gets. Unset: see `preferredClearance`.
  std::optional<double> clearance;
  /// The largest extra length of the path, as a fraction of the length of the shortest path that
  /// was found.
  double detour = 0.1;
  ClearanceOf clearanceOf = ClearanceOf::trajectory;
};

/// The range of the numbers from `lower` to `upper`, both included.
struct ClosedRange {
  double lower, upper;
  constexpr bool contains(double value) const { return lower <= value && value <= upper; }
  /// Returns "a number from 1 to 10000".
  std::string text() const;
};

/// How a trajectory is made along a path.
struct TrajectorySettings {
  /// The legal values of `deviation`, `cornerDeviation` and `rate`.
  static constexpr ClosedRange kDeviations{1e-9, 1}, kCornerDeviations{1e-6, 10}, kRates{1, 10000};

  Smoothing smooth = Smoothing::time;
  /// The largest distance of the written trajectory from the smoothed path, in each number of a
  /// configuration; rad or m.
  double deviation = 1e-4;
  /// The largest distance of the smoothed path from the path, in each number of a configuration;
  /// rad or m. If unset, the smoothed path may be as far from the path as proofs allow. If set,
  /// only corners are rounded.
  std::optional<double> cornerDeviation;
  std::optional<double> rate;  ///< rows per second; unset: rows where they are needed
};

/// The settings of the search for a path. Every member must be legal; the readers of files check
/// ranges and words.
struct Settings {
  PlannerSettings planner;
  ValidSampler sampler = ValidSampler::uniform;
  std::optional<Objective> objective;  ///< `.cfg` only
  /// The cost at which planning may stop, as OMPL's cost threshold of the objective. `.cfg` only.
  double objectiveThreshold = 0;
  Simplifier simplify = Simplifier::corridor;
  PreferSettings prefer;
  CheckerSettings checker;
  TrajectorySettings trajectory;
  std::uint64_t seed = 1;
};

/// Returns the reason why a path can't be moved away from obstacles, in words for a message about
/// the preferred clearance; nullopt if the path can be moved.
std::optional<std::string> whyNoClearance(double margin, const Settings& settings);

/// Returns the first word of `checker.trees` that is unknown or does not belong to the volume, or
/// nullopt if there is none. The methods `adaptive` and `advancement` measure distances. With these
/// two methods, the function also returns the word of an overlap test that is not the volume's
/// default.
std::optional<InvalidName> invalidNameIn(const CheckerSettings& checker);

}  // namespace corridor
