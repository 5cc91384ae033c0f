#include "planner/problem/moveit_request.h"

#include <algorithm>
#include <cmath>

#include "collision/core/read_file.h"
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
const MapKeys kRequest{
    {"workspace_parameters", "start_state", "goal_constraints", "path_constraints",
     "trajectory_constraints", "reference_trajectories", "pipeline_id", "planner_id", "group_name",
     "num_planning_attempts", "allowed_planning_time", "max_velocity_scaling_factor",
     "max_acceleration_scaling_factor", "cartesian_speed_limited_link",
     "cartesian_speed_end_effector_link", "max_cartesian_speed"},
    {}};
const MapKeys kState{
    {"joint_state", "multi_dof_joint_state", "attached_collision_objects", "is_diff"}, {}};
const MapKeys kJointState{{"header", "name", "position", "velocity", "effort"}, {}};
const MapKeys kTransform{{"translation", "rotation"}, {}};
const MapKeys kConstraints{{"name", "joint_constraints", "position_constraints",
                            "orientation_constraints", "visibility_constraints"},
                           {}};
const MapKeys kJointConstraint{
    {"joint_name", "position", "tolerance_above", "tolerance_below", "weight"}, {}};

/// Returns whether a message geometry_msgs/Transform is the identity. A translation or rotation
/// that is absent, or for which a fault was added, counts as the identity.
bool isIdentity(const YamlMap& transform) {
  const auto p = readNamed(transform, "translation", {"x", "y", "z"});
  const auto q = readNamed(transform, "rotation", {"x", "y", "z", "w"});
  const auto isZero = [](double value) { return value == 0; };
  return (!p || std::all_of(p->begin(), p->end(), isZero)) &&
         (!q || std::all_of(q->begin(), q->begin() + 3, isZero));
}

/// Returns the joint values of the request's start state, by the joints' names. Adds a fault for
/// attached objects, and for a pose that is not the identity.
std::map<std::string, double> jointValues(const YamlMap& request) {
  std::map<std::string, double> values;
  const YamlValue* const start = request.find("start_state");
  if (!start) return values;
  const YamlMap state(*start, "start_state", &kState, request.source());
  if (!isEmpty(state, "attached_collision_objects"))
    state.fault("attached_collision_objects", "is not supported; add the objects to the robot");
  if (const YamlValue* const poses = state.find("multi_dof_joint_state")) {
    const YamlMap map(*poses, "start_state.multi_dof_joint_state", nullptr, request.source());
    for (const YamlValue* const item : itemsOf(map, "transforms"))
      if (!isIdentity({*item, map.pathOf("transforms"), &kTransform, request.source()}))
        map.fault("transforms",
                  "a pose that is not the identity is not supported; give it by base, or by start "
                  "in the problem");
  }
  const YamlValue* const joints = state.find("joint_state");
  if (!joints) return values;
  const YamlMap map(*joints, "start_state.joint_state", &kJointState, request.source());
  if (!map.find("name")) return values;
  const auto names = readWords(*map.find("name"), "such as [pan, lift]",
                               "start_state.joint_state.name", request.source());
  if (!names) return values;
  const auto positions = map.numbers("position", names->size());
  if (!positions && !map.find("position")) map.fault("position", "is missing");
  for (std::size_t i = 0; positions && i < names->size(); ++i)
    if (!values.emplace((*names)[i], (*positions)[i]).second)
      map.fault("name", quotedWord((*names)[i]) + " is named twice");
  return values;
}

}  // namespace

MoveitRequest::MoveitRequest(const std::filesystem::path& file, FaultList& faults)
    : document_(parseYaml(file.string(), readTextFile(file, "a motion plan request of MoveIt"))),
      source_{file.string(), faults, {}} {
  for (const char* key : {"world", "robot_state", "allowed_collision_matrix", "robot_model_name"})
    if (hasKey(document_, key))
      throw InputError(Fault{file.string(), 0,
                             "is a planning scene, not a motion plan request (it has " +
                                 std::string(key) + "); write moveit: {scene: FILE}"});
  const std::size_t before = faults.size();
  start_ = jointValues(YamlMap(document_, "", &kRequest, source_));
  startIsRead_ = faults.size() == before;
  if (const YamlValue* const start = root().find("start_state")) startLine_ = start->line;
}

std::string MoveitRequest::group() {
  return root().text("group_name").value_or("");
}

void MoveitRequest::hold(RobotSetup& setup) {
  ModelRobot& robot = setup.robot;
  std::vector<std::string> unknown;
  for (const auto& [name, value] : start_) {
    const auto j = findJoint(robot.description, name);
    if (!j) unknown.push_back(name);
    if (!j || !robot.held.contains(*j) || robot.heldByFile.contains(*j)) continue;
    const JointModel& joint = robot.description.joints[*j];
    const std::string path = "start_state: " + name;
    if (const auto held =
            withinLimits(value, joint.lower, joint.upper, path, robot.description.notes))
      robot.held[*j] = *held, robot.heldFrom[*j] = "start_state of the request";
    else
      source_.fault(startLine_, path + ": " + outsideLimits(value, joint.lower, joint.upper));
  }
  if (!unknown.empty())
    robot.description.notes.push_back({source_.file + ": start_state: the robot has no joint " +
                                           joinedFirst(unknown) + "; the values are not used",
                                       NoteWeight::motion});
}

void MoveitRequest::checkHeld(const std::map<std::string, double>& values, int line,
                              const std::string& path, const ModelRobot& robot) {
  for (const auto& [name, value] : values) {
    const auto j = findJoint(robot.description, name);
    if (!j) {
      source_.fault(line, path + ": " + noSuchJoint(name, robot.description));
      continue;
    }
    const auto held = robot.held.find(*j);
    if (held != robot.held.end() && std::abs(held->second - value) > limitSlack)
      source_.fault(line, path + ": " + name + " is held at " + shortest(held->second) +
                              ", and can't move to " + shortest(value));
  }
}

std::optional<Configuration> MoveitRequest::read(const std::map<std::string, double>& values,
                                                 int line, const std::string& path,
                                                 Problem& problem) {
  Configuration q = Configuration::Zero(static_cast<Eigen::Index>(problem.model.space.size()));
  std::vector<std::string> missing;
  bool sound = true;
  for (const PlannedJoint& planned : problem.model.robots.front().plannedJoints) {
    const auto value = values.find(planned.name);
    if (value == values.end()) {
      missing.push_back(planned.name);
      continue;
    }
    const Coordinate& c = problem.model.space.coordinates()[planned.coordinate];
    std::string why;
    const auto stored =
        coordinateValue(c, value->second, path + ": " + planned.name, problem.source.notes, why);
    sound &= stored.has_value();
    if (stored)
      q[static_cast<Eigen::Index>(c.first)] = *stored;
    else
      source_.fault(line, why);
  }
  if (!missing.empty())
    source_.fault(line, path + ": has no value for " + joinedFirst(missing) +
                            "; all joints that are planned for need one");
  return sound && missing.empty() ? std::optional(std::move(q)) : std::nullopt;
}

void MoveitRequest::readStart(Problem& problem) {
  if (!startIsRead_) return;
  if (auto q = read(start_, startLine_, "start_state", problem)) problem.task.start = std::move(*q);
}

void MoveitRequest::readGoals(Problem& problem) {
  const YamlMap request = root();
  if (const YamlValue* const path = request.find("path_constraints")) {
    const YamlMap map(*path, "path_constraints", &kConstraints, source_);
    for (const char* const key : {"joint_constraints", "position_constraints",
                                  "orientation_constraints", "visibility_constraints"})
      if (!isEmpty(map, key)) map.fault(key, "constraints of the path are not supported");
  }
  if (const YamlValue* const all = request.find("trajectory_constraints")) {
    const YamlMap map(*all, "trajectory_constraints", nullptr, source_);
    if (!isEmpty(map, "constraints"))
      map.fault("constraints", "constraints of the path are not supported");
  }
  const auto goals = itemsOf(request, "goal_constraints");
  if (goals.empty()) request.fault("goal_constraints", "at least one goal is needed");
  for (std::size_t g = 0; g < goals.size(); ++g) {
    const YamlMap goal(*goals[g], "goal_constraints[" + std::to_string(g) + "]", &kConstraints,
                       source_);
    for (const char* const key :
         {"position_constraints", "orientation_constraints", "visibility_constraints"})
      if (!isEmpty(goal, key))
        goal.fault(key, "only goals by joint values are supported (joint_constraints)");
    const std::string path = goal.pathOf("joint_constraints");
    std::map<std::string, double> values;
    for (const YamlValue* const item : itemsOf(goal, "joint_constraints")) {
      const YamlMap one(*item, path, &kJointConstraint, source_);
      one.require("joint_name", "the joint's name");
      one.require("position", "the joint's value");
      const auto name = one.text("joint_name");
      const auto position = one.number("position");
      if (name && position && !values.emplace(*name, *position).second)
        one.fault("joint_name", quotedWord(*name) + " is named twice");
    }
    checkHeld(values, goals[g]->line, path, problem.model.robots.front());
    if (auto q = read(values, goals[g]->line, path, problem))
      problem.task.goals.push_back(std::move(*q));
  }
}

}  // namespace corridor
