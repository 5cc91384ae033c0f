#include "planner/problem/keys.h"

#include <algorithm>

#include "collision/hierarchy/tree_kinds.h"
#include "planner/model/settings.h"

namespace corridor {
namespace {

using Words = std::vector<std::string>;

Words operator+(Words a, const Words& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

const Words placementKeys{"at", "rpy_deg", "rpy", "quat_xyzw"};
const Words poseKeys = placementKeys + Words{"yaw_deg", "yaw"};
const Words shapeKeys =
    Words{"mesh",   "box",     "sphere", "capsule", "cylinder", "convex",   "polygon",
          "points", "octomap", "unit",   "up",      "solid",    "deviation"} +
    placementKeys;

const Words limitKeys{"velocity", "acceleration", "jerk"};
const Words angleLimitKeys = limitKeys + Words{"velocity_deg", "acceleration_deg", "jerk_deg"};

using KeysOfMaps = std::map<std::string, MapKeys>;

/// Sets the legal keys of the map at `path` to the keys of a shape and the keys `more`. Adds the
/// maps inside a shape.
void addShape(KeysOfMaps& keys, const std::string& path, const Words& more) {
  keys[path] = {shapeKeys + more, {}};
  keys[path + ".sphere"] = {{"radius"}, {}};
  keys[path + ".capsule"] = {{"radius", "length"}, {}};
  keys[path + ".cylinder"] = {{"radius", "length"}, {}};
  keys[path + ".points"] = {{"file", "radius"}, {}};
  keys[path + ".octomap"] = {{"file", "unknown", "threshold"}, {}};
}

/// Explains, in each map with a rotation, the keys of quaternions whose scalar comes first.
void explainScalarFirst(KeysOfMaps& keys) {
  for (auto& [path, map] : keys)
    if (std::find(map.legal.begin(), map.legal.end(), "quat_xyzw") != map.legal.end())
      for (const char* key : {"quat_wxyz", "quaternion_wxyz", "wxyz"})
        map.unsupported.push_back({key, "write quat_xyzw: [x, y, z, w], the scalar last"});
}

/// What other programs have, and problems here have not.
std::vector<UnsupportedKey> unsupportedTopics() {
  std::vector<UnsupportedKey> all;
  for (const char* key :
       {"attached", "attach", "attached_object", "attached_objects", "attached_collision_objects"})
    all.push_back({key, "add the object to the robot's URDF, as a link with a fixed joint"});
  for (const char* key : {"constraints", "path_constraints", "keep"})
    all.push_back({key, "goals are joint values, and nothing but margin and limits is kept"});
  return all;
}

KeysOfMaps makeProblemKeys() {
  KeysOfMaps keys{
      {"",
       {{"format", "robot",   "robots",  "base",     "world",   "allow",      "start",
         "goal",   "moveit",  "bounds",  "margin",   "padding", "prefer",     "tube",
         "limits", "planner", "sampler", "simplify", "checker", "trajectory", "seed"},
        unsupportedTopics()}},
      {"moveit", {{"scene", "request"}, {}}},
      {"robots.*", {{"file", "base"}, {}}},
      {"base", {placementKeys, {}}},
      {"start", {poseKeys, {}}},
      {"start.*", {poseKeys, {}}},
      {"goal", {poseKeys + Words{"within"}, {}}},
      {"goal.within", {{"at", "angle_deg", "angle", "joints_deg", "joints"}, {}}},
      {"bounds", {{"at"}, {}}},
      {"tube", {{"joints_deg", "joints", "slides", "position", "rotation_deg", "rotation"}, {}}},
      {"limits",
       {{"file", "velocity_scale", "acceleration_scale", "default", "slides", "position",
         "rotation", "joints", "link_speed"},
        {}}},
      {"limits.default", {angleLimitKeys, {}}},
      {"limits.slides", {limitKeys, {}}},
      {"limits.position", {limitKeys, {}}},
      {"limits.rotation", {angleLimitKeys, {}}},
      {"limits.joints.*", {angleLimitKeys, {}}},
      {"padding", {{"bodies", "pairs"}, {}}},
      {"margin", {{"self", "world", "pairs"}, {}}},
      {"prefer", {{"clearance", "detour", "clearance_of"}, {}}},
      {"trajectory", {{"smooth", "deviation", "corner_deviation", "rate"}, {}}},
      {"planner", {{"name", "time", "stop", "restart", "params"}, {}}},
      {"checker",
       {{"edges", "resolution", "tolerance", "volume", "fit", "overlap", "build"},
        {{"peer", "Corridor's own checker is used; leave it out"}}}},
  };
  addShape(keys, "world.*", {"shapes"});
  addShape(keys, "world.*.shapes[]", {"name"});
  explainScalarFirst(keys);
  return keys;
}

/// What robots of other programs have, and robots here have not.
std::vector<UnsupportedKey> unsupportedMotions() {
  std::vector<UnsupportedKey> all;
  for (const char* key : {"motion_model", "drive", "differential_drive", "diff_drive",
                          "nonholonomic", "steering", "turning_radius"})
    all.push_back({key,
                   "a base moves in any direction, so that it may slide; paths of differential "
                   "drives and cars are not planned for"});
  return all;
}

KeysOfMaps makeRobotKeys() {
  KeysOfMaps keys{
      {"",
       {{"format",           "name",       "urdf",   "srdf",      "xacro",   "packages", "visuals",
         "limits",           "collada_up", "group",  "joints",    "hold",    "states",   "allow",
         "never_in_contact", "rigid",      "shapes", "reference", "weights", "solid"},
        unsupportedMotions()}},
      {"weights", {{"joints", "rotation"}, {}}},
      {"never_in_contact", {{"margin", "beyond_limits", "digest", "pairs"}, {}}},
  };
  addShape(keys, "shapes[]", {"name"});
  explainScalarFirst(keys);
  return keys;
}

/// Returns how a key is written in its maps: "planner: {params: {range: …}}" for the path
/// "planner.params".
std::string nested(std::string path, const std::string& key) {
  std::string text = key + ": …";
  while (!path.empty()) {
    const std::size_t dot = path.rfind('.'), begin = dot == path.npos ? 0 : dot + 1;
    text = path.substr(begin) + ": {" + text + "}";
    path.resize(dot == path.npos ? 0 : dot);
  }
  return text;
}

std::map<std::string, std::string> makeProblemPlaces() {
  // Keys that people write into a wrong map, and the map of each.
  const Words ofPlanner{"time", "stop", "restart", "params"},
      ofParams{"range", "goal_bias"},  // the most common ones of OMPL's planners
      ofChecker{"edges", "resolution", "tolerance", "volume"},
      ofTrajectory{"smooth", "corner_deviation", "rate"},
      ofLimits{"velocity_scale", "acceleration_scale", "link_speed"},
      ofFile{"seed", "margin", "sampler", "simplify"};
  std::map<std::string, std::string> places;
  for (const char* map : {"", "planner.", "checker.", "prefer.", "trajectory.", "limits."})
    for (const auto& [home, keys] :
         std::vector<std::pair<std::string, Words>>{{"planner", ofPlanner},
                                                    {"planner.params", ofParams},
                                                    {"checker", ofChecker},
                                                    {"prefer", {"detour", "clearance_of"}},
                                                    {"trajectory", ofTrajectory},
                                                    {"limits", ofLimits},
                                                    {"", ofFile}})
      for (const std::string& key : keys)
        places[map + key] = nested(home, key) + (home.empty() ? " at the top level" : "");
  for (const std::string& limit : angleLimitKeys)
    places["limits." + limit] =
        nested("limits.default", limit) + ", or limits: {joints: {NAME: {" + limit + ": …}}}";
  places["clearance"] = places["checker.clearance"] =
      "prefer: {clearance: …}, or margin: …, which every path must keep";
  // A key of the file as a whole that contains a path: "planner.time".
  for (const std::string& key : ofParams)
    places["planner.params." + key] = nested("planner.params", key);
  for (const auto& [path, map] : problemKeys())
    if (!path.empty() && path.find_first_of("*[") == path.npos)
      for (const std::string& key : map.legal) places[path + "." + key] = nested(path, key);
  return places;
}

Words volumeNames() {
  Words names;
  for (const VolumeKind& kind : volumeKinds()) names.push_back(kind.name);
  return names;
}

/// Returns the names of one kind (fits, overlap tests or ways of building) of all volumes, each
/// name once.
Words ofAnyVolume(Words VolumeKind::*variants) {
  Words all;
  for (const VolumeKind& kind : volumeKinds())
    for (const std::string& word : kind.*variants)
      if (std::find(all.begin(), all.end(), word) == all.end()) all.push_back(word);
  return all;
}

}  // namespace

const std::map<std::string, MapKeys>& problemKeys() {
  static const KeysOfMaps keys = makeProblemKeys();
  return keys;
}

const std::map<std::string, std::string>& problemPlaces() {
  static const std::map<std::string, std::string> places = makeProblemPlaces();
  return places;
}

const std::map<std::string, MapKeys>& robotKeys() {
  static const KeysOfMaps keys = makeRobotKeys();
  return keys;
}

const std::map<std::string, std::vector<std::string>>& problemChoices() {
  static const std::map<std::string, std::vector<std::string>> choices{
      {"world.*.unit", {"m", "cm", "mm", "in"}},
      {"world.*.up", {"x", "y", "z"}},
      {"world.*.octomap.unknown", {"free", "occupied"}},
      {"planner.stop", {"first", "time"}},
      {"sampler", wordsFor<ValidSampler>()},
      {"trajectory.smooth", wordsFor<Smoothing>()},
      {"prefer.clearance_of", wordsFor<ClearanceOf>()},
      {"checker.edges", wordsFor<EdgeMethod>()},
      {"checker.volume", volumeNames()},
      {"checker.fit", ofAnyVolume(&VolumeKind::fits)},
      {"checker.overlap", ofAnyVolume(&VolumeKind::overlaps)},
      {"checker.build", ofAnyVolume(&VolumeKind::builds)},
  };
  return choices;
}

const std::map<std::string, std::vector<std::string>>& robotChoices() {
  static const std::map<std::string, std::vector<std::string>> choices{
      {"rigid", {"SE3", "SE2"}},
      {"visuals", {"ignore", "collide"}},
      {"limits", {"hard", "soft"}},
      {"collada_up", {"ignore", "file"}},
      {"shapes[].unit", {"m", "cm", "mm", "in"}},
      {"shapes[].up", {"x", "y", "z"}},
      {"shapes[].octomap.unknown", {"free", "occupied"}},
  };
  return choices;
}

}  // namespace corridor
