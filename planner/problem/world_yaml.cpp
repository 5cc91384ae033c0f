#include "planner/problem/world_yaml.h"

#include <algorithm>

#include "collision/core/nearest.h"
#include "planner/problem/keys.h"
#include "planner/problem/shape_yaml.h"

namespace corridor {
namespace {

/// An obstacle of several shapes: {shapes: […], at: …}.
std::vector<PlacedShape> readGroup(const YamlMap& map, ShapePlace place, Problem& problem) {
  for (const char* key :
       {"mesh", "box", "sphere", "capsule", "cylinder", "convex", "unit", "up", "solid"})
    if (map.find(key))
      map.fault(key, "stands with one shape, and shapes lists several; say it there");
  const auto outer = readPlacement(map);
  place.outer = outer.value_or(Placement{});
  return readShapes(map, problemKeys().at("world.*.shapes[]"), place, problem.files);
}

std::vector<std::size_t> bodiesCalled(const std::string& name, const Problem& problem) {
  std::vector<std::size_t> found;
  // A robot that is alone has no prefix; with that of its own name, a link is its, whatever the
  // obstacles are called.
  const ProblemRobot& first = problem.robots.front();
  const std::string own = first.model.name + "/";
  const bool prefixed = first.name.empty() && name.starts_with(own);
  for (std::size_t i = 0; i < problem.bodies.size(); ++i) {
    const ProblemBody& body = problem.bodies[i];
    if (body.name == name || (prefixed && body.robot && body.name == name.substr(own.size())))
      found.push_back(i);
  }
  return found;
}

/// A link that has no shapes: nothing to allow, and no mistake.
bool isBareLink(const std::string& name, const Problem& problem) {
  for (const ProblemRobot& robot : problem.robots)
    for (const LinkModel& link : robot.model.links)
      if (name == (robot.name.empty() ? link.name : robot.name + "/" + link.name)) return true;
  return false;
}

}  // namespace

void readWorld(const YamlMap& file, bool needed, Problem& problem) {
  const YamlValue* world =
      needed ? file.require("world",
                            "the obstacles, such as world: {table: {mesh: table.obj, unit: m}}")
             : file.find("world");
  if (!world) return;
  const YamlMap obstacles(*world, "world", nullptr, file.source());
  if (needed && world->kind == YamlValue::Kind::Map && world->entries.empty())
    file.fault("world", "at least one obstacle is needed");
  for (const YamlValue::Entry* entry : obstacles.entries()) {
    const YamlMap map(entry->value, "world." + entry->key, &problemKeys().at("world.*"),
                      file.source());
    const ShapePlace place{entry->key, problem.file.parent_path(), {}};
    std::vector<PlacedShape> shapes;
    if (map.find("shapes"))
      shapes = readGroup(map, place, problem);
    else if (auto shape = readShape(map, place, problem.files))
      shapes.push_back(std::move(*shape));
    addObstacle(problem, entry->key, std::move(shapes));
  }
}

AllowedBodies readAllow(const YamlMap& file, const Problem& problem) {
  AllowedBodies allowed;
  const YamlValue* value = file.find("allow");
  if (!value) return allowed;
  if (value->kind != YamlValue::Kind::List) {
    file.fault("allow", "a list of pairs of bodies is needed, such as [[hand, table]], not " +
                            described(*value));
    return allowed;
  }
  std::vector<std::string> names;
  for (const ProblemBody& body : problem.bodies) names.push_back(body.name);
  for (const YamlValue& item : value->items) {
    const auto pair = readWords(item, "such as [hand, table]", "allow", file.source());
    if (!pair) continue;
    const auto fault = [&](const std::string& text) {
      file.source().fault(item.line, "allow: " + text);
    };
    if (pair->size() != 2) {
      fault("two bodies are needed, such as [hand, table], not " + std::to_string(pair->size()));
      continue;
    }
    std::vector<std::size_t> bodies;
    for (const std::string& name : *pair) {
      const auto found = bodiesCalled(name, problem);
      if (found.size() == 1)
        bodies.push_back(found.front());
      else if (found.size() > 1)
        fault(quotedWord(name) + " is a link and an obstacle; call the obstacle otherwise");
      else if (!isBareLink(name, problem))
        fault("there is no body " + quotedWord(name) + didYouMean(name, names) + knownWords(names));
    }
    if (bodies.size() == 2) allowed.push_back({bodies[0], bodies[1]});
  }
  return allowed;
}

}  // namespace corridor
