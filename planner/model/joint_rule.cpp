#include "planner/model/joint_rule.h"

#include <algorithm>

namespace corridor {

JointRule ruleOf(const Model& model, std::size_t robot, std::size_t joint) {
  const ModelRobot& own = model.robots[robot];
  JointRule rule;
  if (const auto held = own.held.find(joint); held != own.held.end()) rule.constant = held->second;
  const auto& mimic = own.description.joints[joint].mimic;
  if (!mimic) return rule;
  rule.constant = mimic->offset;
  if (const auto held = own.held.find(mimic->joint); held != own.held.end())
    rule.constant += mimic->multiplier * held->second;
  const auto planned = std::find(own.planned.begin(), own.planned.end(), mimic->joint);
  if (planned == own.planned.end()) return rule;
  const auto k = static_cast<std::size_t>(planned - own.planned.begin());
  rule.leader =
      static_cast<Eigen::Index>(model.space.coordinates()[own.plannedJoints[k].coordinate].first);
  rule.multiplier = mimic->multiplier;
  return rule;
}

}  // namespace corridor
