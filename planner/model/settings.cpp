#include "planner/model/settings.h"

#include "collision/core/spelling.h"

namespace corridor {

template <>
const std::vector<std::string>& wordsFor<EdgeCheck>() {
  static const std::vector<std::string> words = [] {
    std::vector<std::string> all = edgeMethodNames();
    all.push_back("discrete");
    return all;
  }();
  return words;
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

EdgeMethod methodOf(EdgeCheck check) {
  return edgeMethodNamed(wordOf(check)).value_or(EdgeMethod::directional);
}

std::optional<InvalidName> invalidNameIn(const CheckerSettings& checker) {
  if (auto wrong = invalidNameIn(checker.trees)) return wrong;
  const bool measures = methodOf(checker.edges) != EdgeMethod::directional;
  const std::string byDefault = withDefaults({checker.trees.volume, "", ""}).overlap;
  const std::string& overlap = checker.trees.overlap;
  if (!measures || overlap.empty() || overlap == byDefault) return std::nullopt;
  return InvalidName{"overlap", quotedWord(overlap) +
                                    " can't be used with edges: " + wordOf(checker.edges) +
                                    ", which measures distances between volumes; leave overlap "
                                    "out, or use edges: certified"};
}

std::optional<std::string> whyNoClearance(double margin, const Settings& settings) {
  if (margin > 0) return "the path keeps a margin or prefers a clearance, not both; leave one out";
  if (settings.simplify != Simplifier::corridor)
    return "is kept by Corridor's simplifier; it needs simplify: true";
  if (settings.checker.edges == EdgeCheck::discrete)
    return "is proved along edges, and checker.edges: discrete proves none";
  if (settings.objective == Objective::maxMinClearance)
    return "is not for planners that maximise the clearance themselves";
  return std::nullopt;
}

}  // namespace corridor
