#include "planner/problem/world_yaml.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <unordered_map>
#include <utility>

#include "collision/core/rounding.h"
#include "collision/core/spelling.h"
#include "planner/problem/keys.h"
#include "planner/problem/shape_yaml.h"

namespace corridor {
namespace {

/// Reads an obstacle of several shapes: {shapes: […], at: …}.
std::vector<PlacedShape> readGroup(const YamlMap& map, ShapePlace place, ShapeFiles& files) {
  for (const char* key : {"mesh", "box", "sphere", "capsule", "cylinder", "convex", "polygon",
                          "points", "octomap", "unit", "up", "solid", "deviation"})
    if (map.find(key)) map.fault(key, "belongs to one shape; put it into the items of shapes");
  const auto outer = readPlacement(map);
  place.outer = outer.value_or(Placement{});
  return readShapes(map, problemKeys().at("world.*.shapes[]"), place, files);
}

/// Obstacles share a mesh if it has at least `kLeastShared` triangles, and if sharing saves at
/// least `kLeastSaved` triangles. Sharing has a cost: among 20 obstacles that share a mesh, testing
/// an edge of an arm takes 6.9 µs instead of 5.5 µs, since each obstacle has its own relative
/// motion. The gain is that a copy is saved, which would take 0.1 kB and 0.23 µs for each triangle.
/// So saving 50,000 triangles is worth the extra time of 10^4 edges (equal_meshes_benchmark).
constexpr std::size_t kLeastShared = 1'000, kLeastSaved = 50'000;

/// Counts the obstacles that have the same mesh: those with equal values of `mesh`, `unit`, `up`
/// and `solid`.
class MeshUses {
 public:
  void add(const YamlValue& obstacle) { ++uses_[keyOf(obstacle)]; }
  std::size_t of(const YamlValue& obstacle) const { return uses_.at(keyOf(obstacle)); }

 private:
  static std::array<std::string, 4> keyOf(const YamlValue& obstacle) {
    std::array<std::string, 4> key;
    for (const YamlValue::Entry& entry : obstacle.entries)
      for (std::size_t i = 0; i < key.size(); ++i)
        if (entry.key == kKeys[i]) key[i] = entry.value.text;
    return key;
  }
  static constexpr std::array<const char*, 4> kKeys{"mesh", "unit", "up", "solid"};

  std::map<std::array<std::string, 4>, std::size_t> uses_;
};

/// Returns whether obstacles with the same mesh should share the mesh. If they share it, each
/// obstacle has its own frame; if not, each obstacle has its own copy of the mesh, moved to its
/// place. @param uses the number of these obstacles.
bool sharingPays(std::size_t uses, std::size_t triangles) {
  return uses > 1 && (uses - 1) * triangles >= kLeastSaved && triangles >= kLeastShared;
}

using BodiesByName = std::unordered_map<std::string, std::vector<std::size_t>>;

std::vector<std::size_t> bodiesCalled(const std::string& name, const Model& model,
                                      const BodiesByName& bodies) {
  std::vector<std::size_t> found;
  for (const std::string& called : {name, "world/" + name})
    if (const auto same = bodies.find(called); same != bodies.end())
      found.insert(found.end(), same->second.begin(), same->second.end());
  // Links of a single robot have no prefix. A link's name with the robot's name before it is also
  // accepted: it distinguishes the link from an obstacle of the same name.
  const ModelRobot& first = model.robots.front();
  const std::string own = first.description.name + "/";
  if (!first.name.empty() || !name.starts_with(own)) return found;
  if (const auto link = bodies.find(name.substr(own.size())); link != bodies.end())
    for (const std::size_t i : link->second)
      if (model.bodies[i].robot) found.push_back(i);
  return found;
}

/// Returns whether this is the name of a link. A link without shapes is no body. A pair with such a
/// link needs no `allow`, but `allow` may list the pair.
bool isLinkName(const std::string& name, const Model& model) {
  for (const ModelRobot& robot : model.robots)
    for (const LinkModel& link : robot.description.links)
      if (name == (robot.name.empty() ? link.name : robot.name + "/" + link.name)) return true;
  return false;
}

}  // namespace

void readWorld(const YamlMap& file, bool needed, bool isPlanar, ModelBuilder& builder,
               Source& source) {
  const YamlValue* world =
      needed ? file.require("world",
                            "the obstacles, such as world: {table: {mesh: table.obj, unit: m}}")
             : file.find("world");
  if (!world) return;
  const YamlMap obstacles(*world, "world", nullptr, file.source());
  if (needed && world->kind == YamlValue::Kind::Map && world->entries.empty())
    file.fault("world", "at least one obstacle is needed");
  ShapeFiles files{source.files};
  MeshUses uses;
  for (const YamlValue::Entry* entry : obstacles.entries()) uses.add(entry->value);
  for (const YamlValue::Entry* entry : obstacles.entries()) {
    const YamlMap map(entry->value, "world." + entry->key, &problemKeys().at("world.*"),
                      file.source());
    const ShapePlace place{entry->key, source.file.parent_path(), {}, isPlanar};
    if (map.find("shapes")) {
      builder.addObstacle(entry->key, readGroup(map, place, files));
      continue;
    }
    Placement placement;
    auto shape = readShape(map, place, files, &placement);
    if (!shape) continue;
    std::optional<RigidPose> X_WO;  // the pose of the obstacle's own frame, if it has one
    if (shape->mesh && !placement.isIdentity()) {
      if (sharingPays(uses.of(entry->value), shape->mesh->mesh.triangles.size()))
        X_WO = placement.pose;
      else if (!applyPlacement(map, placement, *shape))
        continue;
    }
    builder.addObstacle(entry->key, {std::move(*shape)}, X_WO);
  }
}

/// Finds bodies by the names that users write.
class BodyNames {
 public:
  explicit BodyNames(const Model& model) : model_(model) {
    for (const ModelBody& body : model.bodies) {
      byName_[body.name].push_back(names_.size());
      names_.push_back(body.name);
    }
  }

  /// Returns the body of a name. Returns nullopt for a link without shapes, which is no body. If
  /// the name is unknown, or two bodies have it, calls fault(text) and returns nullopt.
  template <class Report>
  std::optional<std::size_t> find(const std::string& name, const Report& fault) const {
    const auto found = bodiesCalled(name, model_, byName_);
    if (found.size() == 1) return found.front();
    const ModelRobot& robot = model_.robots.front();
    if (found.size() > 1)
      fault(quotedWord(name) + " names a link and an obstacle; write " +
            (robot.name.empty() ? quotedWord(robot.description.name + "/" + name) + " or " : "") +
            quotedWord("world/" + name));
    else if (!isLinkName(name, model_))
      fault("there is no body " + quotedWord(name) + didYouMean(name, names_) + knownWords(names_));
    return std::nullopt;
  }

 private:
  const Model& model_;
  std::vector<std::string> names_;
  BodiesByName byName_;
};

AllowedBodies readAllow(const YamlMap& file, const Model& model) {
  AllowedBodies allowed;
  const YamlValue* value = file.find("allow");
  if (!value) return allowed;
  if (value->kind != YamlValue::Kind::List) {
    file.fault("allow", "a list of pairs of bodies is needed, such as [[hand, table]], not " +
                            described(*value));
    return allowed;
  }
  const BodyNames names(model);
  for (const YamlValue& item : value->items) {
    const auto pair = readWords(item, "as in allow: [[hand, table]]", "allow", file.source());
    if (!pair) continue;
    const auto fault = [&](const std::string& text) {
      file.source().fault(item.line, "allow: " + text);
    };
    if (pair->size() != 2) {
      fault("two bodies are needed, as in allow: [[hand, table]], not " +
            std::to_string(pair->size()));
      continue;
    }
    const auto a = names.find((*pair)[0], fault), b = names.find((*pair)[1], fault);
    if (a && a == b)
      file.source().notes.push_back(
          {"allow: [" + (*pair)[0] + ", " + (*pair)[1] +
           "] names one body twice; name two bodies, or remove the pair"});
    else if (a && b)
      allowed.push_back({*a, *b});
  }
  return allowed;
}

namespace {

/// Reads the list `pairs` of a map: two bodies and a length each. @param key of the map
std::map<std::pair<std::size_t, std::size_t>, double> readPairs(
    const YamlMap& map, const std::string& key, const BodyNames& names,
    const std::function<void(const std::string& link)>& noteNoShapes) {
  std::map<std::pair<std::size_t, std::size_t>, double> all;
  const YamlValue* pairs = map.find("pairs");
  if (!pairs) return all;
  const std::string example = "such as [hand, shelf, 0.02]";
  if (pairs->kind != YamlValue::Kind::List)
    map.fault("pairs",
              "a list of pairs is needed, each with its " + key + " in metres, " + example);
  for (const YamlValue& item : pairs->items) {
    bool isWrong = false;
    const auto fault = [&](const std::string& text) {
      map.source().fault(item.line, key + ".pairs: " + text);
      isWrong = true;
    };
    if (item.kind != YamlValue::Kind::List || item.items.size() != 3) {
      fault("two bodies and a " + key + " in metres are needed, " + example);
      continue;
    }
    const auto a = names.find(item.items[0].text, fault), b = names.find(item.items[1].text, fault);
    double metres = 0;
    if (!isWrong && !(a && b)) noteNoShapes(item.items[a ? 1 : 0].text);
    const std::string wrong = parseNumber(item.items[2].text, Range::NotNegative, metres);
    if (!wrong.empty())
      fault(wrong);
    else if (a && b && *a == *b)
      fault("two different bodies are needed, " + example);
    else if (a && b && !all.try_emplace(std::minmax(*a, *b), metres).second)
      fault("the pair has two " + key + "s");
  }
  return all;
}

}  // namespace

Padding readPadding(const YamlMap& file, const Model& model) {
  Padding padding;
  const YamlValue* value = file.find("padding");
  if (!value) return padding;
  const YamlMap map(*value, "padding", &problemKeys().at("padding"), file.source());
  const BodyNames names(model);
  const auto noteNoShapes = [&](const std::string& link) {
    file.source().notes.push_back(
        {"padding of " + quotedWord(link) + " is not used, because this link has no shapes",
         NoteWeight::coverage});
  };
  if (const YamlValue* bodies = map.find("bodies")) {
    const YamlMap own(*bodies, "padding.bodies", nullptr, file.source());
    for (const YamlValue::Entry* entry : own.entries()) {
      bool isWrong = false;
      const auto body = names.find(entry->key, [&](const std::string& text) {
        own.fault(entry->key, text);
        isWrong = true;
      });
      if (!body && !isWrong) noteNoShapes(entry->key);
      if (const auto metres = own.number(entry->key, Range::NotNegative); metres && body)
        padding.bodies[*body] = *metres;
    }
  }
  padding.pairs = readPairs(map, "padding", names, noteNoShapes);
  return padding;
}

namespace {

/// Reads `margin`, without a test of the sums with paddings.
void readMarginKeys(const YamlMap& file, const Model* model, Task& task) {
  const YamlValue* value = file.find("margin");
  if (value && value->kind == YamlValue::Kind::List) {
    file.fault("margin", "a number or a map {self: …, world: …} is needed, not a list");
    return;
  }
  if (!value || value->kind != YamlValue::Kind::Map) {
    task.margin = file.number("margin", Range::NotNegative).value_or(task.margin);
    return;
  }
  const YamlMap map(*value, "margin", &problemKeys().at("margin"), file.source());
  if (value->entries.empty()) file.fault("margin", "self, world or pairs is needed");
  const double self = map.number("self", Range::NotNegative).value_or(0),
               world = map.number("world", Range::NotNegative).value_or(0);
  if (!model) return;
  const auto pairs = readPairs(map, "margin", BodyNames(*model), [&](const std::string& link) {
    file.source().notes.push_back(
        {"margin.pairs: " + quotedWord(link) + " has no shapes, so its margin is not used",
         NoteWeight::coverage});
  });
  task.margin = std::min(self, world);
  for (const auto& [pair, metres] : pairs) task.margin = std::min(task.margin, metres);
  const auto beyond = [&](double metres) { return sumRoundedUp(metres, -task.margin); };
  MarginsBeyond& all = task.padding.beyond;
  all = {beyond(self), beyond(world), {}};
  for (const auto& [pair, metres] : pairs) all.pairs[pair] = beyond(metres);
}

}  // namespace

void readMargin(const YamlMap& file, const Model* model, Task& task) {
  readMarginKeys(file, model, task);
  if (!std::isfinite(roundedUp(task.margin + task.padding.largest())))
    file.fault(file.find("margin") ? "margin" : "padding", "margin and padding are too large");
}

}  // namespace corridor
