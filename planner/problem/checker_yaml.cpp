#include "planner/problem/checker_yaml.h"

#include "planner/problem/keys.h"

namespace corridor {

void readCheckerKeys(const YamlMap& map, Problem::CheckerSpec& checker) {
  const auto& words = problemChoices();
  checker.edges = map.choice("edges", words.at("checker.edges")).value_or(checker.edges);
  checker.resolution = map.number("resolution", Range::Fraction).value_or(checker.resolution);
  if (const auto tolerance = map.number("tolerance", Range::Positive))
    checker.tolerance = tolerance;
  const std::size_t faults = map.source().faults.size();
  checker.volume = map.choice("volume", words.at("checker.volume")).value_or(checker.volume);
  checker.fit = map.choice("fit", words.at("checker.fit")).value_or(checker.fit);
  checker.overlap = map.choice("overlap", words.at("checker.overlap")).value_or(checker.overlap);
  if (map.source().faults.size() > faults) return;
  if (const auto wrong = invalidNameIn(checker)) map.fault(wrong->key, wrong->text);
}

}  // namespace corridor
