#include "planner/problem/goal_yaml.h"

#include <algorithm>

#include "planner/problem/joint_yaml.h"
#include "planner/problem/keys.h"
#include "planner/problem/state_yaml.h"

namespace corridor {
namespace {

/// Returns the value of a key and marks it as read, or returns nullptr if the key is absent, or is
/// a joint with its value.
const YamlValue* entryOf(const YamlValue& map, const char* key, const Problem& problem) {
  for (const auto& entry : map.entries)
    if (entry.key == key &&
        !isJointValue(problem.model.robots.front().description, key, entry.value)) {
      entry.use = YamlValue::Entry::Use::read;
      return &entry.value;
    }
  return nullptr;
}

const std::set<std::string> kWithin{"within"};

std::string example(const std::string& what, const Problem& problem) {
  const ModelRobot& first = problem.model.robots.front();
  std::string state;
  if (first.description.mount == JointType::floating) {
    state = "{at: [0, 0, 1], rpy_deg: [0, 0, 90]}";
  } else if (first.description.mount == JointType::planar) {
    state = "{at: [0, 0], yaw_deg: 90}";
  } else {
    const PlannedJoint& planned = first.plannedJoints.front();
    const std::vector<std::string> states = usableNames(first.description.states);
    state = states.empty() ? "{" + planned.name +
                                 (planned.type == JointType::planar     ? ": {at: [0, 0]}, …}"
                                  : planned.type == JointType::floating ? ": {at: [0, 0, 1]}, …}"
                                                                        : ": 0.5, …}")
                           : states.front();
  }
  return (first.description.mount == JointType::fixed ? "the robot's joint values at the " + what
                                                      : std::string("the robot's pose")) +
         ", such as " + what + ": " +
         (first.name.empty() ? state : "{" + first.name + ": " + state + ", …}");
}

void readWithin(const YamlValue& value, Problem& problem, YamlSource& source) {
  const YamlMap map(value, "goal.within", &problemKeys().at("goal.within"), source);
  const bool joints = hasSingleJoints(problem.model.space),
             wholes = hasPoseJoints(problem.model.space);
  for (const char* key : {"at", "angle", "angle_deg"})
    if (!wholes && map.find(key))
      map.fault(key,
                "there is no rigid body and no planar or floating joint here; use joints (rad, or "
                "m for prismatic joints)");
  for (const char* key : {"joints", "joints_deg"})
    if (!joints && map.find(key))
      map.fault(key, "there are no revolute or prismatic joints here; use at and angle");
  problem.task.goalRegion = GoalRegion{map.number("at", Range::NotNegative).value_or(0),
                                       map.angle("angle", Range::NotNegative).value_or(0),
                                       map.angle("joints", Range::NotNegative).value_or(0)};
}

/// Returns whether the value is a list of goals. For a single rigid robot, a list counts as a list
/// of goals only if all its items are maps. Any other list, such as [1, 2, 3], is probably meant as
/// a pose.
bool isListOfGoals(const YamlValue& value, const Problem& problem) {
  if (value.kind != YamlValue::Kind::List) return false;
  if (problem.model.robots.size() > 1 ||
      problem.model.robots.front().description.mount == JointType::fixed)
    return true;
  return !value.items.empty() &&
         std::all_of(value.items.begin(), value.items.end(),
                     [](const YamlValue& item) { return item.kind == YamlValue::Kind::Map; });
}

void readGoalList(const YamlValue& list, const std::string& path, StateReader& reader,
                  Problem& problem, YamlSource& source) {
  if (list.kind != YamlValue::Kind::List || list.items.empty()) {
    source.fault(list.line,
                 path + ": a list of at least one goal is needed, not " +
                     (list.kind == YamlValue::Kind::List ? "an empty one" : described(list)));
    return;
  }
  for (std::size_t i = 0; i < list.items.size(); ++i) {
    const YamlValue& item = list.items[i];
    const std::string name = path + "[" + std::to_string(i) + "]";
    source.lines.emplace("goal[" + std::to_string(i) + "]", item.line);
    if (const YamlValue* within = entryOf(item, "within", problem)) {
      source.fault(
          within->line,
          name + ".within: several goals share one region; write goal: {any: […], within: {…}}");
      continue;
    }
    if (auto goal = reader.read(item, name)) problem.task.goals.push_back(std::move(*goal));
  }
}

void readGoals(const YamlValue& value, StateReader& reader, Problem& problem, YamlSource& source) {
  if (isListOfGoals(value, problem)) return readGoalList(value, "goal", reader, problem, source);
  if (const YamlValue* within = entryOf(value, "within", problem))
    readWithin(*within, problem, source);
  if (const YamlValue* any = entryOf(value, "any", problem)) {
    static const MapKeys keys{{"any", "within"}, {}};
    const YamlMap map(value, "goal", &keys, source);
    return readGoalList(*any, "goal.any", reader, problem, source);
  }
  if (auto goal = reader.read(value, "goal", kWithin))
    problem.task.goals.push_back(std::move(*goal));
}

}  // namespace

void readStartAndGoals(const YamlMap& file, bool optional, Problem& problem) {
  StateReader reader(problem, file.source());
  const auto find = [&](const char* key) {
    return optional ? file.find(key) : file.require(key, example(key, problem));
  };
  if (const YamlValue* start = find("start"))
    if (auto q = reader.read(*start, "start")) problem.task.start = std::move(*q);
  if (const YamlValue* goal = find("goal")) readGoals(*goal, reader, problem, file.source());
}

}  // namespace corridor
