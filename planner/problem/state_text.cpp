#include "planner/problem/state_text.h"

#include "collision/core/shortest.h"
#include "planner/problem/text_words.h"
#include "planner/robot/joint_types.h"

namespace corridor {
namespace {

using Number = std::function<std::string(Eigen::Index)>;

std::string listOf(Eigen::Index first, Eigen::Index count, const Number& number) {
  std::string text = "[";
  for (Eigen::Index i = first; i < first + count; ++i) text += (i > first ? ", " : "") + number(i);
  return text + "]";
}

/// Returns the keys of the pose of a planar or floating joint.
std::string poseText(const Configuration& q, Eigen::Index first, JointType type,
                     const Number& number) {
  if (type == JointType::planar)
    return "at: " + listOf(first, 2, number) + ", yaw: " + number(first + 2);
  const bool isTurned = q.segment<4>(first + 3) != Eigen::Vector4d(0, 0, 0, 1);
  return "at: " + listOf(first, 3, number) +
         (isTurned ? ", quat_xyzw: " + listOf(first + 3, 4, number) : "");
}

std::string robotText(const Model& model, const ModelRobot& robot, const Configuration& q,
                      const Number& number) {
  std::string text;
  for (const PlannedJoint& planned : robot.plannedJoints) {
    const auto first =
        static_cast<Eigen::Index>(model.space.coordinates()[planned.coordinate].first);
    const bool isPose = isPoseJoint(planned.type);
    const std::string value = isPose ? poseText(q, first, planned.type, number) : number(first);
    if (robot.isRigid()) return "{" + value + "}";
    text += (text.empty() ? "" : ", ") + yamlWord(planned.name) + ": " +
            (isPose ? "{" + value + "}" : value);
  }
  return "{" + text + "}";
}

}  // namespace

std::string stateText(const Model& model, const Configuration& q, const Number& number) {
  const Number text = number ? number : [&](Eigen::Index i) { return shortest(q[i]); };
  if (model.robots.size() == 1) return robotText(model, model.robots.front(), q, text);
  std::string all;
  for (const ModelRobot& robot : model.robots)
    all +=
        (all.empty() ? "" : ", ") + yamlWord(robot.name) + ": " + robotText(model, robot, q, text);
  return "{" + all + "}";
}

}  // namespace corridor
