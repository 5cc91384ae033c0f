#include "planner/import/moveit_state.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "collision/core/shortest.h"
#include "collision/core/spelling.h"
#include "planner/problem/joint_yaml.h"
#include "planner/problem/state_yaml.h"
#include "planner/problem/urdf_robot.h"
#include "planner/robot/joint_types.h"

namespace corridor {
namespace {

// The fields of the messages. Unknown keys are faults, because a misspelt key may change the
// problem.
const MapKeys kState{
    {"joint_state", "multi_dof_joint_state", "attached_collision_objects", "is_diff"}, {}};
const MapKeys kJointState{{"header", "name", "position", "velocity", "effort"}, {}};

void readJoints(const YamlMap& state, MoveitState& result) {
  const YamlValue* const joints = state.find("joint_state");
  if (!joints || joints->kind == YamlValue::Kind::Null) return;
  const YamlMap map(*joints, state.pathOf("joint_state"), &kJointState, state.source());
  map.ignore({"header", "effort"});
  const YamlValue* const list = map.find("name");
  if (!list) {
    if (!isEmpty(map, "position")) map.fault("position", "there are no names (name)");
    return;
  }
  const auto names = readWords(*list, "such as [pan, lift]", map.pathOf("name"), map.source());
  if (!names) return;
  const auto positions = map.numbers("position", names->size());
  if (!positions && !map.find("position")) map.fault("position", "is missing");
  for (std::size_t i = 0; positions && i < names->size(); ++i)
    if (!result.values.emplace((*names)[i], (*positions)[i]).second)
      map.fault("name", quotedWord((*names)[i]) + " is named twice");
}

/// Returns how far a mimic joint is off its rule in a state, or nullopt if the state or the robot
/// has no value of the joint that it follows.
std::optional<double> offRule(const MoveitState& state, const Mimic& mimic, double value,
                              const ModelRobot& robot) {
  const auto given = state.values.find(robot.description.joints[mimic.joint].name);
  const auto held = robot.held.find(mimic.joint);
  if (held == robot.held.end() && given == state.values.end()) return std::nullopt;
  const double leader = held != robot.held.end() ? held->second : given->second;
  return std::abs(value - (mimic.multiplier * leader + mimic.offset));
}

}  // namespace

std::optional<MoveitState> readMoveitState(const YamlMap& message, std::string_view key) {
  const YamlValue* const value = message.find(key);
  if (!value || value->kind == YamlValue::Kind::Null) return std::nullopt;
  YamlSource& source = message.source();
  const std::size_t before = source.faults.size();
  const YamlMap map(*value, message.pathOf(key), &kState, source);
  MoveitState state;
  state.path = message.pathOf(key);
  state.line = value->line;
  if (!isEmpty(map, "attached_collision_objects"))
    map.fault("attached_collision_objects", "is not supported; add the objects to the robot");
  if (map.flag("is_diff").value_or(false))
    source.notes.push_back(
        {source.file + ": " + map.pathOf("is_diff") +
             ": the state is a difference to another one, which is not in the file; joints that it "
             "does not name are at the values of the robot's file, and no object is attached",
         NoteWeight::coverage});
  state.poses = readMessagePoses(map);
  readJoints(map, state);
  state.isSound = source.faults.size() == before;
  return state;
}

void holdAt(const MoveitState& state, const std::string& origin, const YamlSource& source,
            RobotSetup& setup) {
  ModelRobot& robot = setup.robot;
  std::vector<Note>& notes = robot.description.notes;
  std::vector<std::string> unknown, fixed, kept, replaced, off, alone;
  for (const auto& [name, value] : state.values) {
    const auto j = findJoint(robot.description, name);
    if (!j) unknown.push_back(name);
    if (j && value != 0 && robot.description.joints[*j].type == JointType::fixed)
      fixed.push_back(name);
    if (!j || !robot.held.contains(*j)) continue;
    const JointModel& joint = robot.description.joints[*j];
    if (robot.heldByFile.contains(*j)) {
      if (robot.held[*j] != value)
        kept.push_back(name + " (" + shortest(robot.held[*j]) + ", not " + shortest(value) + ")");
      continue;
    }
    const std::string path = state.path + ": " + name;
    if (const auto earlier = robot.heldFrom.find(*j);
        earlier != robot.heldFrom.end() && robot.held[*j] != value)
      replaced.push_back(name + " (" + shortest(robot.held[*j]) + ")");
    if (const auto held = withinLimits(value, joint.lower, joint.upper, path, notes))
      robot.held[*j] = *held, robot.heldFrom[*j] = origin;
    else
      source.fault(state.line, path + ": " + outsideLimits(value, joint.lower, joint.upper));
  }
  for (const auto& [name, value] : state.values) {
    const auto j = findJoint(robot.description, name);
    if (!j || !robot.description.joints[*j].mimic) continue;
    const auto by = offRule(state, *robot.description.joints[*j].mimic, value, robot);
    if (!by)
      alone.push_back(name);
    else if (*by > limitSlack)
      off.push_back(name);
  }
  const auto note = [&](const std::string& text, const std::vector<std::string>& names,
                        const std::string& end) {
    if (!names.empty())
      notes.push_back({source.file + ": " + state.path + ": " + text + joinedFirst(names) + end,
                       NoteWeight::coverage});
  };
  note("the robot has no joint ", unknown, "; the values are not used");
  note("not used, because the joints are fixed in the URDF: ", fixed, "");
  note("held by robot.yaml at another value: ", kept, "");
  note("used instead of the scene's robot_state: ", replaced, "");
  note("not used, because they differ from the rule of a mimic joint: ", off,
       "; the proof is for the rule");
  note("not used, because the joints that these mimic joints follow have no value here: ", alone,
       "");
}

std::optional<Configuration> plannedValues(const MoveitState& state, const YamlSource& source,
                                           Problem& problem) {
  Configuration q = Configuration::Zero(static_cast<Eigen::Index>(problem.model.space.size()));
  std::vector<std::string> missing;
  bool sound = true;
  for (const PlannedJoint& planned : problem.model.robots.front().plannedJoints) {
    const auto value = state.values.find(planned.name);
    if (value == state.values.end()) {
      missing.push_back(planned.name);
      continue;
    }
    const Coordinate& c = problem.model.space.coordinates()[planned.coordinate];
    std::string why;
    const auto stored = coordinateValue(c, value->second, state.path + ": " + planned.name,
                                        problem.source.notes, why);
    sound &= stored.has_value();
    if (stored)
      q[static_cast<Eigen::Index>(c.first)] = *stored;
    else
      source.fault(state.line, why);
  }
  if (!missing.empty())
    source.fault(state.line, state.path + ": has no value for " + joinedFirst(missing) +
                                 "; all joints that are planned for need one");
  return sound && missing.empty() ? std::optional(std::move(q)) : std::nullopt;
}

void compareWithProblem(const MoveitState& state, const Problem& problem, YamlSource& source) {
  const std::string& file = source.file;
  std::vector<Note>& notes = source.notes;
  std::vector<std::string> others;
  for (const PlannedJoint& planned : problem.model.robots.front().plannedJoints) {
    const auto given = state.values.find(planned.name);
    const Coordinate& c = problem.model.space.coordinates()[planned.coordinate];
    const auto at = static_cast<Eigen::Index>(c.first);
    if (given == state.values.end() || problem.task.start.size() <= at) continue;
    const double off = given->second - problem.task.start[at];
    if (std::abs(c.kind == Coordinate::Kind::circle ? std::remainder(off, 2 * std::numbers::pi)
                                                    : off) > limitSlack)
      others.push_back(planned.name);
  }
  if (!others.empty())
    notes.push_back({file + ": " + state.path + ": the start has other values of " +
                         joinedFirst(others) + "; those of the start are used",
                     NoteWeight::motion});
  // The start of the problem may hold joints, too (`holdAsStart`).
  const ModelRobot& robot = problem.model.robots.front();
  std::vector<std::string> replaced;
  for (const auto& [j, held] : robot.held) {
    const auto given = state.values.find(robot.description.joints[j].name);
    const auto from = robot.heldFrom.find(j);
    if (given != state.values.end() && from != robot.heldFrom.end() &&
        from->second.starts_with("start: ") && held != given->second)
      replaced.push_back(given->first + " (" + shortest(held) + ", not " + shortest(given->second) +
                         ")");
  }
  if (!replaced.empty())
    notes.push_back({file + ": " + state.path +
                         ": held by the problem's start at another value: " + joinedFirst(replaced),
                     NoteWeight::coverage});
  for (const MessagePose& pose : state.poses)
    if (const auto conflict = conflictOf(pose, problem.model, problem.task.start, "start")) {
      if (conflict->isChosen)
        notes.push_back({file + ": " + conflict->text, NoteWeight::coverage});
      else
        source.fault(pose.line, conflict->text + "; " + conflict->fix);
    }
}

}  // namespace corridor
