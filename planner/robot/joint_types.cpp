#include "planner/robot/joint_types.h"

namespace corridor {
namespace {

constexpr JointType types[] = {JointType::fixed,     JointType::revolute, JointType::continuous,
                               JointType::prismatic, JointType::planar,   JointType::floating};

}  // namespace

std::string nameOf(JointType type) {
  switch (type) {
    case JointType::fixed:
      return "fixed";
    case JointType::revolute:
      return "revolute";
    case JointType::continuous:
      return "continuous";
    case JointType::prismatic:
      return "prismatic";
    case JointType::planar:
      return "planar";
    case JointType::floating:
      return "floating";
  }
  return "";
}

std::optional<JointType> jointType(std::string_view name) {
  for (const JointType type : types)
    if (nameOf(type) == name) return type;
  return std::nullopt;
}

std::vector<std::string> jointTypeNames() {
  std::vector<std::string> names;
  for (const JointType type : types) names.push_back(nameOf(type));
  return names;
}

bool isPoseJoint(JointType type) {
  return type == JointType::planar || type == JointType::floating;
}

bool hasOwnValue(const JointModel& joint) {
  return joint.type != JointType::fixed && !joint.mimic;
}

std::optional<std::size_t> findJoint(const RobotDescription& model, std::string_view name) {
  for (std::size_t j = 0; j < model.joints.size(); ++j)
    if (model.joints[j].name == name) return j;
  return std::nullopt;
}

}  // namespace corridor
