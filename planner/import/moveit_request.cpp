#include "planner/import/moveit_request.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "collision/core/read_file.h"
#include "collision/core/shortest.h"
#include "collision/core/spelling.h"
#include "planner/model/joint_rule.h"
#include "planner/problem/joint_yaml.h"
#include "planner/problem/urdf_robot.h"
#include "planner/problem/yaml_ledger.h"
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
const MapKeys kConstraints{{"name", "joint_constraints", "position_constraints",
                            "orientation_constraints", "visibility_constraints"},
                           {}};
const MapKeys kJointConstraint{
    {"joint_name", "position", "tolerance_above", "tolerance_below", "weight"}, {}};

}  // namespace

MoveitRequest::MoveitRequest(const std::filesystem::path& file, FaultList& faults)
    : document_(parseYaml(file.string(), readTextFile(file, "a motion plan request of MoveIt"))),
      source_{file.string(), faults, {}} {
  for (const char* key : {"world", "robot_state", "allowed_collision_matrix", "robot_model_name"})
    if (hasKey(document_, key))
      throw InputError(Fault{file.string(), 0,
                             "is a planning scene, not a motion plan request (it has " +
                                 std::string(key) + "); write moveit: {scene: FILE}"});
  const YamlMap request(document_, "", &kRequest, source_);
  request.ignore({"pipeline_id", "planner_id", "num_planning_attempts", "allowed_planning_time"});
  start_ = readMoveitState(request, "start_state");
}

std::string MoveitRequest::group() {
  return root().textOrNone("group_name");
}

void MoveitRequest::hold(RobotSetup& setup) {
  if (start_) holdAt(*start_, "start_state of the request", source_, setup);
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

void MoveitRequest::checkFollowers(const std::map<std::string, double>& values, int line,
                                   const std::string& path, const Configuration& q,
                                   const Problem& problem) {
  const ModelRobot& robot = problem.model.robots.front();
  const auto isPlanned = [&](const std::string& name) {
    return std::ranges::any_of(robot.plannedJoints,
                               [&](const PlannedJoint& planned) { return planned.name == name; });
  };
  std::vector<std::string> unused;
  for (const auto& [name, value] : values) {
    const auto j = findJoint(robot.description, name);
    if (!j || robot.held.contains(*j) || isPlanned(name)) continue;
    const JointModel& joint = robot.description.joints[*j];
    if (!joint.mimic) {
      unused.push_back(name);
      continue;
    }
    const JointModel& leader = robot.description.joints[joint.mimic->joint];
    const double own = ruleOf(problem.model, 0, *j).at(q);
    // Angles that differ by whole turns are the same pose; lengths that differ by 2π are not.
    const bool turns = joint.type == JointType::continuous ||
                       (joint.type == JointType::revolute && leader.type == JointType::continuous);
    const double off = turns ? std::remainder(value - own, 2 * std::numbers::pi) : value - own;
    if (std::abs(off) > limitSlack)
      source_.fault(line, path + ": " + name + " follows " + leader.name + " (mimic), and is at " +
                              shortest(own) + " there, not at " + shortest(value));
  }
  if (!unused.empty())
    source_.notes.push_back(
        {source_.file + ": " + path +
             ": not used, because the joints are fixed or need a pose: " + joinedFirst(unused),
         NoteWeight::motion});
}

void MoveitRequest::readStart(Problem& problem) {
  if (start_ && !start_->isSound) return;
  if (auto q =
          plannedValues(start_.value_or(MoveitState{"start_state", 0, true, {}}), source_, problem))
    problem.task.start = std::move(*q);
}

void MoveitRequest::readGoals(Problem& problem) {
  const YamlMap request = root();
  if (const YamlValue* const path = request.find("path_constraints")) {
    const YamlMap map(*path, "path_constraints", &kConstraints, source_);
    map.ignore({"name"});
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
    goal.ignore({"name"});
    for (const char* const key :
         {"position_constraints", "orientation_constraints", "visibility_constraints"})
      if (!isEmpty(goal, key))
        goal.fault(key, "only goals by joint values are supported (joint_constraints)");
    const std::string path = goal.pathOf("joint_constraints");
    std::map<std::string, double> values;
    for (const YamlValue* const item : itemsOf(goal, "joint_constraints")) {
      const YamlMap one(*item, path, &kJointConstraint, source_);
      one.ignore({"tolerance_above", "tolerance_below", "weight"});  // the goal is the position
      one.require("joint_name", "the joint's name");
      one.require("position", "the joint's value");
      const auto name = one.text("joint_name");
      const auto position = one.number("position");
      if (name && position && !values.emplace(*name, *position).second)
        one.fault("joint_name", quotedWord(*name) + " is named twice");
    }
    checkHeld(values, goals[g]->line, path, problem.model.robots.front());
    if (auto q = plannedValues({path, goals[g]->line, true, values}, source_, problem)) {
      checkFollowers(values, goals[g]->line, path, *q, problem);
      problem.task.goals.push_back(std::move(*q));
    }
  }
}

std::vector<Note> MoveitRequest::takeNotes(const Problem& problem) {
  if (start_) compareWithProblem(*start_, problem, source_);
  std::vector<Note> notes = std::exchange(source_.notes, {});
  addAll(notesOnUnread(document_, source_.file, DefaultValues::sayNothing), notes);
  return notes;
}

}  // namespace corridor
