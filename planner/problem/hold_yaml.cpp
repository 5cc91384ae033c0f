#include "planner/problem/hold_yaml.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "collision/core/spelling.h"
#include "planner/problem/joint_yaml.h"
#include "planner/problem/urdf_robot.h"
#include "planner/robot/joint_types.h"

namespace corridor {

std::optional<std::string> readHold(const YamlMap& file, RobotSetup& setup) {
  const YamlValue* value = file.find("hold");
  if (!value) return std::nullopt;
  if (value->kind == YamlValue::Kind::Scalar) return value->text;
  const RobotDescription& model = setup.robot.description;
  const YamlMap map(*value, "hold", nullptr, file.source());
  std::vector<Note>& notes = setup.robot.description.notes;
  const auto read = [&](std::size_t j, const YamlValue::Entry& entry, bool degrees) {
    const JointModel& joint = model.joints[j];
    if (!hasOwnValue(joint)) return map.fault(entry.key, whyNotActive(model, j));
    const std::string path = map.pathOf(entry.key);
    if (isPoseJoint(joint.type)) {
      if (const auto pose = readJointPose(entry.value, path, joint, file.source(), notes))
        setup.robot.heldPoses[j] = pose->pose, setup.robot.heldByFile.insert(j),
        setup.robot.heldFrom[j] = "hold";
      return;
    }
    const auto number = map.number(entry.key);
    if (!number) return;
    const double radians = degrees ? *number * (std::numbers::pi / 180) : *number;
    if (const auto held = withinLimits(radians, joint.lower, joint.upper, path, notes))
      setup.robot.held[j] = *held, setup.robot.heldByFile.insert(j),
      setup.robot.heldFrom[j] = "hold";
    else
      map.fault(entry.key,
                outsideLimits(radians, joint.lower, joint.upper,
                              joint.type == JointType::revolute && !degrees ? joint.name : ""));
  };
  readJointValues(map, model, read, {"from"});
  const YamlValue* const from = map.find("from");
  return from && !isJointValue(model, "from", *from) ? map.text("from") : std::nullopt;
}

const NamedState* findState(const RobotDescription& model, const std::string& name,
                            const YamlPlace& place) {
  const auto fault = [&](const std::string& text) {
    place.source.fault(place.line, place.path + ": " + text);
    return nullptr;
  };
  const auto state = model.states.find(name);
  if (state == model.states.end()) {
    const std::vector<std::string> known = usableNames(model.states);
    std::vector<std::string> ofGroups;  // the full names of states with this name in groups
    for (const auto& [full, found] : model.states)
      if (!found.group.empty() && full == found.group + "/" + name) ofGroups.push_back(full);
    if (!ofGroups.empty())
      return fault("several groups have a state " + quotedWord(name) +
                   "; write the group, too: " + joined(ofGroups));
    return fault("there is no state " + quotedWord(name) + didYouMean(name, known) +
                 (known.empty() ? " (neither robot.yaml nor SRDF names any)" : knownWords(known)));
  }
  if (!state->second.unusable.empty())
    return fault("the state " + quotedWord(name) + " can't be used: " + state->second.unusable);
  return &state->second;
}

std::optional<RigidPose> poseIn(const NamedState& state, const JointModel& joint) {
  const auto number = [&](const char* part) {
    const auto found = state.values.find(joint.name + part);
    return found == state.values.end() ? 0 : found->second;
  };
  if (!state.values.contains(joint.name + "/x")) return std::nullopt;
  RigidPose pose;
  pose.p = Vec3(number("/x"), number("/y"), number("/z"));
  pose.q = joint.type == JointType::planar
               ? fromRpy(Vec3(0, 0, number("/yaw"))).q
               : Eigen::Quaterniond(number("/qw"), number("/qx"), number("/qy"), number("/qz"));
  return pose;
}

void holdState(const std::string& name, const std::vector<std::size_t>& planned,
               const YamlPlace& place, RobotSetup& setup) {
  ModelRobot& robot = setup.robot;
  const NamedState* const state = findState(robot.description, name, place);
  if (!state) return;
  bool holds = false;
  for (std::size_t j = 0; j < robot.description.joints.size(); ++j) {
    const JointModel& joint = robot.description.joints[j];
    if (!hasOwnValue(joint) || robot.heldByFile.contains(j)) continue;
    if (std::find(planned.begin(), planned.end(), j) != planned.end()) continue;
    if (isPoseJoint(joint.type)) {
      const auto pose = poseIn(*state, joint);
      holds |= pose.has_value();
      if (pose && pose->q.squaredNorm() > 0)
        robot.heldPoses[j] = *pose, robot.heldFrom[j] = place.path + ": " + name;
      else if (pose)
        place.source.fault(
            place.line, place.path + " (" + name + "): " + joint.name + ": the quaternion is zero");
      continue;
    }
    const auto value = state->values.find(joint.name);
    if (value == state->values.end()) continue;
    holds = true;
    const std::string path = place.path + " (" + name + "): " + joint.name;
    if (const auto held =
            withinLimits(value->second, joint.lower, joint.upper, path, robot.description.notes))
      robot.held[j] = *held, robot.heldFrom[j] = place.path + ": " + name;
    else
      place.source.fault(place.line,
                         path + ": " + outsideLimits(value->second, joint.lower, joint.upper));
  }
  if (!holds && place.path == "hold")
    robot.description.notes.push_back(
        {"hold: the state " + quotedWord(name) + " has no value for a held joint",
         NoteWeight::motion});
}

void holdAsStart(const YamlMap& problem, std::vector<RobotSetup>& robots) {
  const YamlValue* start = problem.find("start");
  const auto entryOf = [](const YamlValue& map, const std::string& key) -> const YamlValue* {
    if (map.kind != YamlValue::Kind::Map) return nullptr;
    for (const YamlValue::Entry& entry : map.entries)
      if (entry.key == key) return &entry.value;
    return nullptr;
  };
  for (RobotSetup& setup : robots) {
    const std::string& robot = setup.robot.name;
    const YamlValue* value = start && !robot.empty() ? entryOf(*start, robot) : start;
    if (const YamlValue* from = value ? entryOf(*value, "from") : nullptr;
        from && !isJointValue(setup.robot.description, "from", *from))
      value = from;
    if (!value || value->kind != YamlValue::Kind::Scalar) continue;
    const auto state = setup.robot.description.states.find(value->text);
    // Unknown and unusable states are skipped here, because StateReader reports them.
    if (state == setup.robot.description.states.end() || !state->second.unusable.empty()) continue;
    holdState(value->text, setup.robot.planned,
              {problem.source(), robot.empty() ? "start" : "start." + robot, value->line}, setup);
  }
}

}  // namespace corridor
