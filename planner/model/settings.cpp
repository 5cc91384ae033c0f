#include "planner/model/settings.h"

#include "collision/core/shortest.h"
#include "collision/core/spelling.h"

namespace corridor {

template <>
const std::vector<std::string>& wordsFor<EdgeMethod>() {
  return edgeMethodNames();
}

template <>
const std::vector<std::string>& wordsFor<ValidSampler>() {
  static const std::vector<std::string> words{"uniform", "gaussian", "obstacle_based",
                                              "bridge_test", "max_clearance"};
  return words;
}

template <>
const std::vector<std::string>& wordsFor<Objective>() {
  static const std::vector<std::string> words{"length", "max_min_clearance", "mechanical_work"};
  return words;
}

template <>
const std::vector<std::string>& wordsFor<Simplifier>() {
  static const std::vector<std::string> words{"true", "false", "ompl"};
  return words;
}

template <>
const std::vector<std::string>& wordsFor<Smoothing>() {
  static const std::vector<std::string> words{"none", "corners", "time", "length", "acceleration"};
  return words;
}

template <>
const std::vector<std::string>& wordsFor<ClearanceOf>() {
  static const std::vector<std::string> words{"trajectory", "path"};
  return words;
}

std::string ClosedRange::text() const {
  return "a number from " + shortest(lower) + " to " + shortest(upper);
}

std::optional<InvalidName> invalidNameIn(const CheckerSettings& checker) {
  if (auto wrong = invalidNameIn(checker.trees)) return wrong;
  const bool measures = proves(checker.edges) && checker.edges != EdgeMethod::certified;
  const std::string byDefault = withDefaults({checker.trees.volume, "", ""}).overlap;
  const std::string& overlap = checker.trees.overlap;
  if (!measures || overlap.empty() || overlap == byDefault) return std::nullopt;
  return InvalidName{"overlap", quotedWord(overlap) +
                                    " can't be used with edges: " + wordOf(checker.edges) +
                                    ", which measures distances between volumes; leave overlap "
                                    "out, or use edges: certified"};
}

std::optional<std::string> whyNoClearance(double margin, const Settings& settings) {
  if (margin > 0) return "can't be used if every pair has a margin; leave one of the two out";
  if (settings.simplify != Simplifier::corridor)
    return "needs Corridor's simplifier; leave out simplify: false or ompl (--no-simplify, "
           "--simplify)";
  if (!proves(settings.checker.edges))
    return "needs edges that are proved; discrete edges are only sampled";
  if (settings.objective == Objective::maxMinClearance)
    return "can't be used with the objective max_min_clearance";
  return std::nullopt;
}

}  // namespace corridor
