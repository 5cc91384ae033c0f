#include "planner/problem/checker_yaml.h"

#include "planner/problem/keys.h"

namespace corridor {

void readCheckerKeys(const YamlMap& map, Problem::CheckerSpec& checker) {
  const auto& words = problemChoices();
  checker.edges = map.choice("edges", words.at("checker.edges")).value_or(checker.edges);
  checker.resolution = map.number("resolution", Range::Fraction).value_or(checker.resolution);
  if (const auto tolerance = map.number("tolerance", Range::Positive))
    checker.tolerance = tolerance;
  checker.fit = map.choice("fit", words.at("checker.fit")).value_or(checker.fit);
}

}  // namespace corridor
