#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "collision/core/read_file.h"
#include "collision/core/spelling.h"
#include "planner/problem/limits_yaml.h"
#include "planner/problem/yaml_ledger.h"

namespace corridor {
namespace {

const MapKeys kFile{{"joint_limits", "default_velocity_scaling_factor",
                     "default_acceleration_scaling_factor", "cartesian_limits"},
                    {}};
const MapKeys kJoint{{"has_velocity_limits",
                      "max_velocity",
                      "min_velocity",
                      "has_acceleration_limits",
                      "max_acceleration",
                      "min_acceleration",
                      "has_deceleration_limits",
                      "max_deceleration",
                      "has_jerk_limits",
                      "max_jerk",
                      "min_jerk",
                      "has_position_limits",
                      "min_position",
                      "max_position",
                      "has_effort_limits",
                      "max_effort",
                      "angle_wraparound",
                      "has_soft_limits",
                      "soft_lower_limit",
                      "soft_upper_limit",
                      "k_position",
                      "k_velocity"},
                     {}};

/// Returns `max_WHAT` if `has_WHAT_limits` is true; otherwise, or if a fault was added, returns
/// nullopt. A deceleration may be negative, as Pilz's planner of MoveIt requires; its absolute
/// value is returned.
std::optional<double> readLimit(const YamlMap& joint, const std::string& what,
                                std::vector<Note>& notes) {
  const std::string flag = "has_" + what + "_limits", key = "max_" + what;
  const auto has = joint.flag(flag);
  if (!joint.find(flag)) {
    if (what == "deceleration" && joint.find(key)) {
      notes.push_back({joint.source().file + ": " + joint.pathOf(key) + " is not used without " +
                           flag + ": true (MoveIt's rule)",
                       NoteWeight::motion});
      joint.ignore({key});
    } else if (joint.find(key))
      joint.fault(
          key, "MoveIt ignores this limit without " + flag + "; add " + flag + ": true (or false)");
    return std::nullopt;
  }
  // If has_… is false, MoveIt's files often have max_…: 0.
  if (!has.value_or(false)) {
    joint.ignore({key});
    return std::nullopt;
  }
  joint.require(key, "the limit, such as " + key + ": 2");
  const bool isSigned = what == "deceleration";
  auto value = joint.quotableNumber(key, isSigned ? Range::Any : Range::Positive);
  if (!value) return std::nullopt;
  if (joint.find(key)->inDegrees) *value *= std::numbers::pi / 180;
  if (*value == 0) {
    joint.fault(key, "must not be 0");
    return std::nullopt;
  }
  return std::abs(*value);
}

void readFile(const YamlMap& map, const Model& model, bool isComplete, LimitSpec& spec,
              std::vector<Note>& notes) {
  const std::string& file = map.source().file;
  if (isComplete && map.find("cartesian_limits"))
    notes.push_back(
        {file + ": cartesian_limits are not used; set link_speed in the problem instead",
         NoteWeight::motion});
  map.ignore({"cartesian_limits"});
  readScale(map, "default_velocity_scaling_factor", spec.velocityScale);
  readScale(map, "default_acceleration_scaling_factor", spec.accelerationScale);
  const YamlValue* value =
      map.require("joint_limits", "{JOINT: {has_velocity_limits: true, max_velocity: 2}}");
  if (!value) return;
  const std::vector<LimitedJoint> joints = jointsWithLimits(model);
  std::vector<std::string> known, notPlanned, unknown, positions, soft;
  for (const ModelRobot& robot : model.robots)
    for (const JointModel& joint : robot.description.joints) known.push_back(joint.name);
  const YamlMap limits(*value, map.pathOf("joint_limits"), nullptr, map.source());
  for (const YamlValue::Entry* entry : limits.entries()) {
    const YamlMap own(entry->value, limits.pathOf(entry->key), &kJoint, map.source());
    own.ignore({"min_position", "max_position", "has_effort_limits", "max_effort",
                "angle_wraparound", "soft_lower_limit", "soft_upper_limit", "k_position",
                "k_velocity"});
    const auto names = [&](const char* a, const char* b) { return own.find(a) || own.find(b); };
    LimitValues values;
    values.velocity = readLimit(own, "velocity", notes);
    values.acceleration = readLimit(own, "acceleration", notes);
    if (const auto slowing = readLimit(own, "deceleration", notes))
      values.acceleration = std::min(values.acceleration.value_or(*slowing), *slowing);
    values.jerk = readLimit(own, "jerk", notes);
    if (own.flag("has_position_limits").value_or(names("min_position", "max_position")))
      positions.push_back(entry->key);
    if (own.flag("has_soft_limits").value_or(names("soft_lower_limit", "soft_upper_limit")))
      soft.push_back(entry->key);
    bool used = false;
    for (const LimitedJoint& joint : joints) {
      if (joint.plain != entry->key) continue;
      spec.named[joint.name] = values;
      used = true;
    }
    if (used) continue;
    const bool isKnown = std::find(known.begin(), known.end(), entry->key) != known.end();
    (isKnown ? notPlanned : unknown).push_back(entry->key);
  }
  if (!isComplete) return;
  if (const std::size_t unused = notPlanned.size() + unknown.size();
      unused > 0 && unused == limits.entries().size()) {
    notPlanned.insert(notPlanned.end(), unknown.begin(), unknown.end());
    return map.fault("joint_limits",
                     "no joint of this file is planned for: " + joinedFirst(notPlanned));
  }
  for (const std::string& name : unknown)
    notes.push_back(
        {file + ": no robot here has the joint " + quotedWord(name) + didYouMean(name, known),
         NoteWeight::motion});
  if (!notPlanned.empty())
    notes.push_back({file + ": limits of " + joinedFirst(notPlanned) +
                         " are not used, because these joints are not planned for",
                     NoteWeight::detail});
  if (!positions.empty())
    notes.push_back({file + ": limits of the position of " + joinedFirst(positions) +
                         " are not used; set bounds in the problem instead",
                     NoteWeight::motion});
  if (!soft.empty())
    notes.push_back({file + ": soft limits of " + joinedFirst(soft) +
                         " are not used; set bounds in the problem instead",
                     NoteWeight::motion});
}

const YamlValue* valueIn(const YamlValue& map, std::string_view key) {
  for (const YamlValue::Entry& entry : map.entries)
    if (entry.key == key) return &entry.value;
  return nullptr;
}

/// Returns the parameters in a file for ROS 2 (`/**: {ros__parameters: …}`): those of the node that
/// has limits, or of the first node if no node has limits. Adds a fault if several nodes have
/// limits. Returns any other document unchanged.
const YamlValue& parametersOf(const YamlValue& document, const YamlSource& source) {
  const YamlValue *first = nullptr, *found = nullptr;
  for (const YamlValue::Entry& node : document.entries) {
    const YamlValue* const own = valueIn(node.value, "ros__parameters");
    if (!own) continue;
    if (!first) first = own;
    if (!valueIn(*own, "robot_description_planning") && !valueIn(*own, "joint_limits")) continue;
    if (found)
      source.fault(node.line, quotedWord(node.key) +
                                  " is a second node with limits of joints; keep one of them");
    else
      found = own;
  }
  return found ? *found : first ? *first : document;
}

/// Adds a fault for each `joint_limits` beside the map that is read, and a note for each scaling
/// factor there.
void requireOneSet(const YamlValue& document, const YamlValue& parameters, const YamlValue* inner,
                   const YamlSource& source, std::vector<Note>& notes) {
  const auto fault = [&](const YamlValue& map) {
    if (const YamlValue* const second = valueIn(map, "joint_limits"))
      source.fault(second->line, "a second joint_limits, which is not read; keep one of them");
    for (const char* key :
         {"default_velocity_scaling_factor", "default_acceleration_scaling_factor"})
      if (const YamlValue* const scale = valueIn(map, key))
        notes.push_back({source.file + ":" + std::to_string(scale->line) + ": " + key +
                             " is not used, because it does not stand beside joint_limits",
                         NoteWeight::motion});
  };
  if (inner) fault(parameters);
  if (&parameters == &document) return;
  fault(document);
  if (const YamlValue* const outer = valueIn(document, "robot_description_planning")) fault(*outer);
}

/// Adds a note on limits elsewhere in the document, which are not read: maps `joint_limits` at
/// other places, and dotted names of parameters of ROS 2.
/// @param read the map whose `joint_limits` are read. @param path that of `value`.
void noteOtherLimits(const YamlValue& value, const YamlValue& read, const std::string& path,
                     const std::string& file, std::vector<Note>& notes) {
  for (const YamlValue::Entry& entry : value.entries) {
    const std::string own = path.empty() ? entry.key : path + "." + entry.key;
    const bool isDotted = entry.key.find("joint_limits.") != std::string::npos;
    if (isDotted || (entry.key == "joint_limits" && &value != &read))
      notes.push_back({file + ":" + std::to_string(entry.value.line) +
                           ": the limits of joints in " + quotedWord(own) + " are not read",
                       NoteWeight::motion});
    else if (entry.key != "joint_limits")
      noteOtherLimits(entry.value, read, own, file, notes);
  }
}

}  // namespace

void readMoveitLimits(const std::filesystem::path& file, const Model& model, bool isComplete,
                      LimitSpec& spec, FaultList& faults, std::vector<Note>& notes) {
  const YamlValue document =
      parseYaml(file.string(), readTextFile(file, "limits of joints (MoveIt's joint_limits.yaml)"),
                {.angleTags = true});
  YamlSource source{file.string(), faults, {}};
  // Parameter files, and files that launch files load, have the limits under the key
  // `robot_description_planning`, beside other keys.
  const YamlValue& parameters = parametersOf(document, source);
  const YamlValue* const inner = valueIn(parameters, "robot_description_planning");
  std::vector<Note> beside;
  requireOneSet(document, parameters, inner, source, beside);
  if (isComplete) addAll(beside, notes);
  if (isComplete && faults.size() == 0)
    noteOtherLimits(document, inner ? *inner : parameters, "", file.string(), notes);
  const YamlValue& read = inner ? *inner : parameters;
  readFile(YamlMap(read, inner ? "robot_description_planning" : "", &kFile, source), model,
           isComplete, spec, notes);
  if (isComplete && faults.size() == 0)
    addAll(notesOnUnread(read, file.string(), DefaultValues::sayNothing), notes);
}

}  // namespace corridor
