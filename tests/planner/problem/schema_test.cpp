#include <algorithm>
#include <fstream>
#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "planner/benchmark/campaign_yaml.h"
#include "planner/problem/keys.h"

namespace corridor::test {
namespace {

using Json = nlohmann::json;

/// Follows references, and takes the first alternative that is a map with keys of its own.
const Json& resolved(const Json& root, const Json& schema) {
  if (schema.contains("$ref"))
    return resolved(root,
                    root.at(Json::json_pointer(schema.at("$ref").get<std::string>().substr(1))));
  if (!schema.contains("properties") && schema.contains("anyOf"))
    for (const Json& alternative : schema.at("anyOf"))
      if (const Json& found = resolved(root, alternative); found.contains("properties"))
        return found;
  return schema;
}

/// Returns the schema of the map at `path`, which has the form of the paths in problemKeys: "",
/// "world.*", "shapes[]", "goal.within".
const Json& schemaOf(const Json& root, const std::string& path) {
  const Json* at = &root;
  for (std::size_t begin = 0; begin < path.size();) {
    const std::size_t end = std::min(path.find('.', begin), path.size());
    std::string word = path.substr(begin, end - begin);
    begin = end + 1;
    const bool isList = word.ends_with("[]");
    if (isList) word.resize(word.size() - 2);
    at = &resolved(root,
                   word == "*" ? at->at("additionalProperties") : at->at("properties").at(word));
    if (isList) at = &resolved(root, at->at("items"));
  }
  return *at;
}

/// Maps whose keys may be names of robots and joints.
const std::set<std::string> open{"start", "goal", "bounds", "tube"};

void collectMaps(const Json& schema, std::set<const Json*>& maps) {
  if (schema.is_object() && schema.contains("properties")) maps.insert(&schema);
  if (schema.is_structured())
    for (const Json& part : schema) collectMaps(part, maps);
}

void expectInStep(const std::string& file, const std::map<std::string, MapKeys>& keys,
                  const std::map<std::string, std::vector<std::string>>& choices) {
  std::ifstream stream(CORRIDOR_SOURCE_DIR + ("/" + file));
  ASSERT_TRUE(stream) << file;
  const Json root = Json::parse(stream);
  std::set<const Json*> maps, known;
  collectMaps(root, maps);
  for (const auto& [path, map] : keys) {
    const Json& schema = schemaOf(root, path);
    known.insert(&schema);
    EXPECT_EQ(schema.at("additionalProperties") == false, !open.contains(path)) << path;
    std::set<std::string> properties;
    for (const auto& [key, value] : schema.at("properties").items()) properties.insert(key);
    EXPECT_EQ(properties, std::set<std::string>(map.legal.begin(), map.legal.end()))
        << file << ": " << path;
  }
  EXPECT_EQ(maps, known) << "the schema has maps that the reader does not accept";
  for (const auto& [path, words] : choices)
    EXPECT_EQ(schemaOf(root, path).at("enum").get<std::vector<std::string>>(), words) << path;
}

TEST(Schema, ProblemIsInStepWithTheReader) {
  expectInStep("problems/problem.schema.json", problemKeys(), problemChoices());
}

TEST(Schema, RobotIsInStepWithTheReader) {
  expectInStep("robots/robot.schema.json", robotKeys(), robotChoices());
}

TEST(Schema, CampaignIsInStepWithTheReader) {
  expectInStep("planner/benchmark/campaign.schema.json", campaignKeys(), {});
}

}  // namespace
}  // namespace corridor::test
