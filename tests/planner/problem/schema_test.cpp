#include <algorithm>
#include <fstream>
#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "planner/problem/keys.h"

namespace corridor::test {
namespace {

using Json = nlohmann::json;

/// The schema of the map at `path` of the key lists: "", "world.*", "shapes[]", "goal.within".
const Json& schemaOf(const Json& root, const std::string& path) {
  const Json* at = &root;
  for (std::size_t begin = 0; begin < path.size();) {
    const std::size_t end = std::min(path.find('.', begin), path.size());
    std::string word = path.substr(begin, end - begin);
    begin = end + 1;
    const bool isList = word.ends_with("[]");
    if (isList) word.resize(word.size() - 2);
    at = word == "*" ? &at->at("additionalProperties") : &at->at("properties").at(word);
    if (isList) at = &at->at("items");
  }
  return *at;
}

void countMaps(const Json& schema, std::size_t& maps) {
  if (schema.is_object() && schema.contains("properties")) ++maps;
  if (schema.is_structured())
    for (const Json& part : schema) countMaps(part, maps);
}

void expectInStep(const std::string& file, const std::map<std::string, MapKeys>& keys,
                  const std::map<std::string, std::vector<std::string>>& choices) {
  std::ifstream stream(CORRIDOR_SOURCE_DIR + ("/" + file));
  ASSERT_TRUE(stream) << file;
  const Json root = Json::parse(stream);
  for (const auto& [path, map] : keys) {
    const Json& schema = schemaOf(root, path);
    EXPECT_EQ(schema.at("additionalProperties"), false) << path;
    std::set<std::string> properties;
    for (const auto& [key, value] : schema.at("properties").items()) properties.insert(key);
    EXPECT_EQ(properties, std::set<std::string>(map.legal.begin(), map.legal.end()))
        << file << ": " << path;
  }
  std::size_t maps = 0;
  countMaps(root, maps);
  EXPECT_EQ(maps, keys.size()) << "the schema has maps that the reader does not know";
  for (const auto& [path, words] : choices)
    EXPECT_EQ(schemaOf(root, path).at("enum").get<std::vector<std::string>>(), words) << path;
}

TEST(Schema, ProblemIsInStepWithTheReader) {
  expectInStep("problems/problem.schema.json", problemKeys(), problemChoices());
}

TEST(Schema, RobotIsInStepWithTheReader) {
  expectInStep("robots/robot.schema.json", robotKeys(), robotChoices());
}

}  // namespace
}  // namespace corridor::test
