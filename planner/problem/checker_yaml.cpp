#include "planner/problem/checker_yaml.h"

#include "planner/problem/keys.h"

namespace corridor {

void readCheckerKeys(const YamlMap& map, CheckerSettings& checker) {
  const auto& words = problemChoices();
  if (const auto edges = map.choice("edges", wordsFor<EdgeMethod>()))
    checker.edges = *choiceNamed<EdgeMethod>(*edges);
  checker.resolution = map.number("resolution", Range::Resolution).value_or(checker.resolution);
  if (const auto tolerance = map.number("tolerance", Range::Positive))
    checker.tolerance = tolerance;
  const std::size_t faults = map.source().faults.size();
  TreeNames& trees = checker.trees;
  if (const YamlValue* volume = map.find("volume"); volume && volume->text == "octree")
    map.fault("volume",
              "octree can't prove motions: it has only `corridor query --volume octree`, for "
              "interference of two meshes; choose another volume, such as aabb");
  else
    trees.volume = map.choice("volume", words.at("checker.volume")).value_or(trees.volume);
  trees.fit = map.choice("fit", words.at("checker.fit")).value_or(trees.fit);
  trees.overlap = map.choice("overlap", words.at("checker.overlap")).value_or(trees.overlap);
  trees.build = map.choice("build", words.at("checker.build")).value_or(trees.build);
  if (map.source().faults.size() > faults) return;
  if (const auto wrong = invalidNameIn(checker)) map.fault(wrong->key, wrong->text);
}

}  // namespace corridor
