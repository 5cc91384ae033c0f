#include "planner/problem/state_yaml.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "collision/core/shortest.h"
#include "collision/core/spelling.h"
#include "planner/problem/bounds_of_ends.h"
#include "planner/problem/hold_yaml.h"
#include "planner/problem/joint_yaml.h"
#include "planner/problem/keys.h"
#include "planner/problem/urdf_robot.h"

namespace corridor {
namespace {

constexpr const char* kHowToPlanForIt =
    "; give it another value by hold in the robot's file, or plan for it by joints or group";

}  // namespace

/// The components of one robot's state, by their names in the robot ("pan", "base/yaw"). Each
/// component has its line and its path, for messages.
struct StateReader::Given {
  struct Number {
    double value = 0;
    int line = 0;
    std::string path;
  };
  std::map<std::string, Number> numbers;
};

std::optional<double> coordinateValue(const Coordinate& coordinate, double value,
                                      const std::string& path, std::vector<Note>& notes,
                                      std::string& why, DegreesHint hint) {
  const std::string angle = hint == DegreesHint::none || path.ends_with("_deg")
                                ? ""  // a value in degrees needs no hint
                                : coordinate.name;
  if (coordinate.kind == Coordinate::Kind::circle) {
    if (-std::numbers::pi < value && value <= std::numbers::pi) return value;
    double wrapped = wrappedYaw(value);
    if (wrapped <= -std::numbers::pi) wrapped = std::numbers::pi;
    notes.push_back(
        {path + ": " + shortest(value) + " is read as " + shortest(wrapped) +
         ", the same angle up to full turns" +
         (angle.empty() ? ""
                        : degreesHint(value, -2 * std::numbers::pi, 2 * std::numbers::pi, angle))});
    return wrapped;
  }
  const auto within = withinLimits(value, coordinate.lower, coordinate.upper, path, notes);
  if (!within)
    why = path + ": " +
          outsideLimits(value, coordinate.lower, coordinate.upper, coordinate.angular ? angle : "");
  return within;
}

std::optional<Configuration> StateReader::read(const YamlValue& value, const std::string& path,
                                               const std::set<std::string>& others) {
  Configuration q = Configuration::Zero(static_cast<Eigen::Index>(problem_.model.space.size()));
  if (isAlone()) return readRobot(0, value, path, others, q) ? std::optional(q) : std::nullopt;

  std::vector<std::string> names;
  for (const ModelRobot& robot : robots()) names.push_back(robot.name);
  if (value.kind != YamlValue::Kind::Map) {
    source_.fault(value.line, path + ": a map from robot names to states is needed, such as {" +
                                  names.front() + ": …}, not " + described(value));
    return std::nullopt;
  }
  MapKeys keys{names, {}};
  keys.legal.insert(keys.legal.end(), others.begin(), others.end());
  const YamlMap map(value, path, &keys, source_);
  bool sound = true;
  for (std::size_t r = 0; r < names.size(); ++r) {
    const YamlValue* own = map.require(names[r], "where this robot is");
    sound &= own && readRobot(r, *own, map.pathOf(names[r]), {}, q);
  }
  return sound ? std::optional(q) : std::nullopt;
}

bool StateReader::readRobot(std::size_t robot, const YamlValue& value, const std::string& path,
                            const std::set<std::string>& others, Configuration& q) {
  const RobotDescription& model = robots()[robot].description;
  if (model.mount != JointType::fixed) return readRigid(robot, value, path, others, q);
  Given given;
  if (value.kind == YamlValue::Kind::Scalar)
    return fromNamed(robot, value.text, value.line, path, given) &&
           apply(robot, given, value.line, path, q);
  if (value.kind != YamlValue::Kind::Map) {
    source_.fault(value.line, path +
                                  ": a named state or joint values, such as {pan: 0.3, lift_deg: "
                                  "20}, are needed, not " +
                                  described(value));
    return false;
  }
  const YamlMap map(value, path, nullptr, source_);
  if (const YamlValue* const from = map.find("from"); from && !isJointValue(model, "from", *from)) {
    const auto name = map.text("from");
    if (!name || !fromNamed(robot, *name, from->line, map.pathOf("from"), given)) return false;
  }
  return readJoints(robot, map, given, others) && apply(robot, given, value.line, path, q);
}

bool StateReader::readRigid(std::size_t robot, const YamlValue& value, const std::string& path,
                            const std::set<std::string>& others, Configuration& q) {
  const RobotDescription& model = robots()[robot].description;
  const bool spatial = model.mount == JointType::floating;
  PoseForm form{spatial,
                (isAlone() ? "the robot" : robots()[robot].name) +
                    (spatial ? " moves in SE3 (rigid: SE3)" : " moves in SE2 (rigid: SE2)"),
                &problemKeys().at(others.contains("within") ? "goal" : "start")};
  const auto pose = readPose(value, path, form, source_, problem_.source.notes);
  if (!pose) return false;
  const PlannedJoint& planned = robots()[robot].plannedJoints.front();
  const auto first =
      static_cast<Eigen::Index>(problem_.model.space.coordinates()[planned.coordinate].first);
  if (spatial)
    q.segment<7>(first) << pose->pose.p, pose->pose.q.coeffs();
  else
    q.segment<3>(first) << pose->pose.p.head<2>(), pose->yaw;
  return isInBounds(planned, q, value.line, path);
}

bool StateReader::fromNamed(std::size_t robot, const std::string& name, int line,
                            const std::string& path, Given& given) {
  const RobotDescription& model = robots()[robot].description;
  const NamedState* const state = findState(model, name, {source_, path, line});
  if (!state) return false;
  for (const auto& [number, value] : state->values)
    given.numbers[number] = {value, line, path + " (" + name + "): " + number};
  return checkHeld(robot, *state, name, line, path);
}

bool StateReader::checkHeld(std::size_t robot, const NamedState& state, const std::string& name,
                            int line, const std::string& path) {
  const RobotDescription& model = robots()[robot].description;
  const bool isGoal = path.starts_with("goal");
  bool sound = true;
  const auto disagree = [&](std::size_t joint, const std::string& text) {
    const bool isFault = isGoal && !robots()[robot].heldByFile.contains(joint);
    if (isFault)
      source_.fault(line,
                    text +
                        "; the joint is not planned for, so it cannot move: start from a state "
                        "with the goal's value, or set this value in hold");
    else
      problem_.source.notes.push_back({text, NoteWeight::motion});
    sound &= !isFault;
  };
  for (const auto& [j, held] : robots()[robot].held) {
    const JointModel& joint = model.joints[j];
    const auto value = state.values.find(joint.name);
    if (value == state.values.end()) continue;
    const bool turns = joint.type == JointType::continuous;
    const double off =
        turns ? std::remainder(value->second - held, 2 * std::numbers::pi) : value->second - held;
    if (std::abs(off) <= limitSlack) continue;
    disagree(j, path + ": " + joint.name + " is held at " + shortest(held) + ", but is " +
                    shortest(value->second) + " in state " + name);
  }
  for (const auto& [j, held] : robots()[robot].heldPoses) {
    const auto pose = poseIn(state, model.joints[j]);
    if (!pose || ((pose->p - held.p).norm() <= limitSlack &&
                  pose->q.normalized().angularDistance(held.q.normalized()) <= limitSlack))
      continue;
    disagree(j,
             path + ": " + model.joints[j].name + " is held at another pose than in state " + name);
  }
  return sound;
}

bool StateReader::readJoints(std::size_t robot, const YamlMap& map, Given& given,
                             const std::set<std::string>& others) {
  const RobotDescription& model = robots()[robot].description;
  const ModelRobot& setup = robots()[robot];
  const std::size_t before = source_.faults.size();
  std::set<std::string> known = others;
  known.insert("from");
  readJointValues(
      map, model,
      [&](std::size_t j, const YamlValue::Entry& entry, bool degrees) {
        const JointModel& joint = model.joints[j];
        const std::string path = map.pathOf(entry.key);
        if (joint.type == JointType::fixed && map.number(entry.key).value_or(0) == 0)
          return;  // its value, or a fault
        if (const std::string why = whyNotActive(model, j); !why.empty())
          return map.fault(entry.key, why);
        if (const auto held = setup.held.find(j); held != setup.held.end()) {
          const auto number = map.number(entry.key);
          const double value = number.value_or(0) * (degrees ? std::numbers::pi / 180 : 1);
          if (number && !(std::abs(value - held->second) <= equalUpToRounding(held->second)))
            map.fault(entry.key,
                      joint.lower == joint.upper
                          ? "its limits are equal: " + shortest(joint.lower) + " is its only value"
                          : "is held at " + shortest(held->second) + ", and not planned for" +
                                kHowToPlanForIt);
          return;
        }
        if (setup.heldPoses.contains(j))
          return map.fault(entry.key,
                           std::string("is held, and not planned for") + kHowToPlanForIt);
        if (isPoseJoint(joint.type)) {
          const auto pose = readJointPose(entry.value, path, joint, source_, problem_.source.notes);
          if (!pose) return;
          for (const auto& [number, value] : numbersOf(joint, *pose))
            given.numbers[number] = {value, entry.line, path};
          return;
        }
        auto number = map.number(entry.key);
        if (!number) return;
        if (degrees) {
          if (joint.type == JointType::continuous && wrappedYawDegrees(*number) != *number) {
            const double wrapped = wrappedYawDegrees(*number);
            problem_.source.notes.push_back({path + ": " + shortest(*number) + " is read as " +
                                             shortest(wrapped) +
                                             ", the same angle up to full turns"});
            number = wrapped;
          }
          *number *= std::numbers::pi / 180;
        }
        given.numbers[joint.name] = {*number, entry.line, path};
      },
      known);
  return source_.faults.size() == before;
}

bool StateReader::apply(std::size_t robot, const Given& given, int line, const std::string& path,
                        Configuration& q) {
  std::vector<std::string> missing;
  bool sound = true;
  const auto find = [&](const std::string& name) -> const Given::Number* {
    const auto found = given.numbers.find(name);
    if (found != given.numbers.end()) return &found->second;
    missing.push_back(name);
    return nullptr;
  };
  for (const PlannedJoint& planned : robots()[robot].plannedJoints) {
    if (!isPoseJoint(planned.type)) {
      if (const auto* number = find(planned.name))
        sound &= setSingle(planned, number->value, number->line, number->path, q);
      continue;
    }
    const bool planar = planned.type == JointType::planar;
    auto index =
        static_cast<Eigen::Index>(problem_.model.space.coordinates()[planned.coordinate].first);
    const std::size_t before = missing.size();
    int at = line;
    for (const char* part : planar ? std::vector{"/x", "/y", "/yaw"}
                                   : std::vector{"/x", "/y", "/z", "/qx", "/qy", "/qz", "/qw"})
      if (const auto* number = find(planned.name + part)) {
        q[index++] = number->value;
        at = number->line;
      }
    if (missing.size() == before)
      sound &= isInBounds(planned, q, at, path + "." + planned.name);
    else
      missing.resize(before), missing.push_back(planned.name);
  }
  if (missing.empty()) return sound;
  source_.fault(line, path + ": has no value for " + joined(missing) +
                          "; all joints that are planned for need one");
  return false;
}

bool StateReader::setSingle(const PlannedJoint& planned, double value, int line,
                            const std::string& path, Configuration& q) {
  const Coordinate& coordinate = problem_.model.space.coordinates()[planned.coordinate];
  std::string why;
  const auto stored =
      coordinateValue(coordinate, value, path, problem_.source.notes, why, DegreesHint::key);
  if (stored)
    q[static_cast<Eigen::Index>(coordinate.first)] = *stored;
  else
    source_.fault(line, why);
  return stored.has_value();
}

bool StateReader::isInBounds(const PlannedJoint& planned, const Configuration& q, int line,
                             const std::string& path) const {
  for (const CoordinateGroup& group : problem_.model.space.groups()) {
    if (group.coordinates.front() != planned.coordinate) continue;
    const std::string why = whyOutside(problem_.model.space, group, q);
    if (why.empty()) continue;
    source_.fault(line, path + ": " + why);
    return false;
  }
  return true;
}

}  // namespace corridor
