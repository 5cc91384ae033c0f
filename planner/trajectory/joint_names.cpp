#include <algorithm>

#include "planner/robot/joint_types.h"
#include "planner/trajectory/trajectory_table.h"

namespace corridor {
namespace {

using Kind = JointNames::Meaning::Kind;

Kind kindOf(const ModelRobot& robot, std::size_t joint) {
  if (robot.description.joints[joint].mimic) return Kind::mimic;
  return robot.held.contains(joint) ? Kind::held : Kind::other;
}

}  // namespace

JointNames::JointNames(const Model& model) {
  const auto add = [&](const std::string& name, const Meaning& meaning) {
    if (meanings_.emplace(name, meaning).second) known_.push_back(name);
  };
  const std::vector<std::string> numbers = model.space.numberNames();
  for (std::size_t i = 0; i < numbers.size(); ++i) add(numbers[i], {Kind::number, i, 0});
  numberCount_ = numbers.size();
  for (std::size_t r = 0; r < model.robots.size(); ++r) {
    const ModelRobot& robot = model.robots[r];
    const std::string prefix = robot.name.empty() ? "" : robot.name + "/";
    const std::vector<JointModel>& joints = robot.description.joints;
    for (std::size_t j = 0; j < joints.size(); ++j)
      if (std::find(robot.planned.begin(), robot.planned.end(), j) == robot.planned.end())
        add(prefix + joints[j].name, {kindOf(robot, j), j, r});
  }
  for (const ModelRobot& robot : model.robots) {
    const std::string prefix = robot.name + "/";
    for (const std::string& name : known_)
      if (!robot.name.empty() && name.starts_with(prefix))
        short_[name.substr(prefix.size())].push_back(name);
  }
}

std::optional<JointNames::Meaning> JointNames::find(const std::string& name) const {
  if (const auto found = meanings_.find(name); found != meanings_.end()) return found->second;
  const auto full = short_.find(name);
  if (full == short_.end() || full->second.size() != 1) return std::nullopt;
  return meanings_.at(full->second.front());
}

std::string JointNames::ambiguous(const std::string& name) const {
  const auto full = short_.find(name);
  if (meanings_.contains(name) || full == short_.end() || full->second.size() < 2) return "";
  std::string all;
  for (const std::string& one : full->second) all += (all.empty() ? "" : " or ") + one;
  return all;
}

}  // namespace corridor
