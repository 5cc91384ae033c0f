#include "planner/problem/limits_yaml.h"

#include <algorithm>

#include "collision/core/read_file.h"
#include "collision/core/shortest.h"
#include "collision/core/spelling.h"
#include "planner/problem/assembly.h"
#include "planner/problem/keys.h"
#include "planner/problem/shape_yaml.h"

namespace corridor {
namespace {

/// Reads {velocity: …, acceleration: …, jerk: …}.
/// @param isLength whether the limits are in metres, so that degrees are not legal.
/// @param owner what the limits apply to, for messages: "elbow", "limits.position".
LimitValues readValues(const YamlMap& map, bool isLength, const std::string& owner) {
  LimitValues values;
  const auto read = [&](const std::string& key) {
    const std::string degrees = key + "_deg";
    if (isLength && map.find(degrees)) {
      map.fault(degrees, owner + " is a length; use " + key + ", in metres");
      return std::optional<double>();
    }
    return map.angle(key, Range::Positive);
  };
  values.velocity = read("velocity");
  values.acceleration = read("acceleration");
  values.jerk = read("jerk");
  return values;
}

LimitValues readSection(const YamlMap& limits, const char* key, bool isLength) {
  const YamlValue* value = limits.find(key);
  if (!value) return {};
  const YamlMap map(*value, limits.pathOf(key), &problemKeys().at(std::string("limits.") + key),
                    limits.source());
  return readValues(map, isLength, limits.pathOf(key));
}

void readNamed(const YamlMap& limits, const std::vector<LimitedJoint>& joints, LimitSpec& spec) {
  const YamlValue* value = limits.find("joints");
  if (!value) return;
  std::vector<std::string> known;
  for (const LimitedJoint& joint : joints) known.push_back(joint.name);
  const YamlMap map(*value, limits.pathOf("joints"), nullptr, limits.source());
  for (const YamlValue::Entry* entry : map.entries()) {
    const auto joint = std::find_if(joints.begin(), joints.end(), [&](const LimitedJoint& each) {
      return each.name == entry->key;
    });
    if (joint == joints.end()) {
      map.fault(entry->key, "no planned joint has this name" + didYouMean(entry->key, known) +
                                knownWords(known));
      continue;
    }
    const YamlMap own(entry->value, map.pathOf(entry->key), &problemKeys().at("limits.joints.*"),
                      limits.source());
    const LimitValues values = readValues(own, joint->isPrismatic, entry->key);
    LimitValues& named = spec.named[entry->key];  // each value in the problem replaces the value in
                                                  // the file of MoveIt
    if (values.velocity) named.velocity = values.velocity;
    if (values.acceleration) named.acceleration = values.acceleration;
    if (values.jerk) named.jerk = values.jerk;
  }
}

void readLinkSpeeds(const YamlMap& limits, const Model& model, LimitSpec& spec) {
  const YamlValue* value = limits.find("link_speed");
  if (!value) return;
  std::vector<std::string> known;
  for (const ModelRobot& robot : model.robots)
    for (const LinkModel& link : robot.description.links)
      known.push_back(robot.name.empty() ? link.name : robot.name + "/" + link.name);
  const YamlMap map(*value, limits.pathOf("link_speed"), nullptr, limits.source());
  for (const YamlValue::Entry* entry : map.entries()) {
    if (std::find(known.begin(), known.end(), entry->key) == known.end())
      map.fault(entry->key, "there is no link of that name" + didYouMean(entry->key, known) +
                                knownWords(known));
    else if (const auto speed = map.number(entry->key, Range::Positive))
      spec.links[entry->key] = *speed;
  }
}

}  // namespace

void readScale(const YamlMap& limits, const char* key, double& scale) {
  const auto value = limits.number(key, Range::Positive);
  if (value && *value > 1)
    limits.fault(key, "at most 1 is needed: it is a share of the limits");
  else if (value)
    scale = *value;
}

LimitSpec readLimits(const YamlMap& problem, const std::filesystem::path& folder,
                     const Model& model, bool isComplete,
                     std::vector<std::filesystem::path>& files) {
  const YamlValue* value = problem.find("limits");
  if (!value) return {};
  if (isComplete)
    for (const LimitedJoint& joint : jointsWithLimits(model))
      problem.source().places["limits." + joint.name] =
          "limits: {joints: {" + joint.name + ": {velocity: …}}}";
  const YamlMap map(*value, "limits", &problemKeys().at("limits"), problem.source());
  return readLimitMap(map, folder, model, isComplete, files);
}

LimitSpec readLimitMap(const YamlMap& map, const std::filesystem::path& folder, const Model& model,
                       bool isComplete, std::vector<std::filesystem::path>& files) {
  LimitSpec spec;
  if (const auto name = map.text("file")) {
    const std::filesystem::path file = folder / *name;
    if (const std::string why = whyNotOrdinaryFile(file); !why.empty()) {
      map.fault("file", file.string() + ": " + why);
    } else {
      addFile(files, file);
      FaultList& faults = map.source().faults;
      faults.collect(
          [&] { readMoveitLimits(file, model, isComplete, spec, faults, map.source().notes); });
    }
  }
  for (const auto& [key, scale] : {std::pair("velocity_scale", &spec.velocityScale),
                                   std::pair("acceleration_scale", &spec.accelerationScale)}) {
    if (*scale != 1 && !map.find(key))
      map.source().notes.push_back({"the file's default factor makes " + std::string(key) + " " +
                                        shortest(*scale) + "; limits: {" + key + ": 1} replaces it",
                                    NoteWeight::motion});
    readScale(map, key, *scale);
  }
  spec.joints = readSection(map, "default", false);
  spec.slides = readSection(map, "slides", true);
  spec.position = readSection(map, "position", true);
  spec.rotation = readSection(map, "rotation", false);
  if (!isComplete) return spec;
  const std::vector<LimitedJoint> joints = jointsWithLimits(model);
  readNamed(map, joints, spec);
  readLinkSpeeds(map, model, spec);
  if (map.find("default") && joints.empty())
    map.fault("default",
              "there are no revolute or prismatic joints here; use position and rotation");
  if (map.find("slides") &&
      std::none_of(joints.begin(), joints.end(),
                   [](const LimitedJoint& joint) { return joint.isPrismatic; }))
    map.fault("slides", "there is no prismatic joint here that is planned for");
  for (const char* key : {"position", "rotation"})
    if (map.find(key) && !hasPoseJoints(model.space))
      map.fault(key,
                "there is no rigid body and no planar or floating joint here; use default or "
                "joints");
  return spec;
}

}  // namespace corridor
