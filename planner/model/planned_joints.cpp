#include "planner/model/planned_joints.h"

#include <algorithm>
#include <string>

#include "collision/core/shortest.h"
#include "collision/core/spelling.h"
#include "planner/robot/joint_types.h"

namespace corridor {

bool canMove(const JointModel& joint) {
  return movesItself(joint) && joint.lower != joint.upper;
}

std::vector<std::size_t> allMoving(const ModelRobot& robot) {
  std::vector<std::size_t> all;
  for (std::size_t j = 0; j < robot.model.joints.size(); ++j)
    if (canMove(robot.model.joints[j]) && !robot.held.contains(j) && !robot.heldPoses.contains(j))
      all.push_back(j);
  return all;
}

void chooseJoints(ModelRobot& robot, const std::vector<std::size_t>& active) {
  robot.planned = active;
  RobotModel& model = robot.model;
  std::string held;
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const JointModel& joint = model.joints[j];
    if (!movesItself(joint) || robot.held.contains(j) || robot.heldPoses.contains(j) ||
        std::find(active.begin(), active.end(), j) != active.end())
      continue;
    if (isPoseJoint(joint.type)) {
      robot.heldPoses[j] = {};
      held += (held.empty() ? "" : ", ") + joint.name + " not moved";
    } else {
      const bool ends = joint.type != JointType::continuous;
      robot.held[j] = ends ? std::clamp(0.0, joint.lower, joint.upper) : 0.0;
      held += (held.empty() ? "" : ", ") + joint.name + " " + shortest(robot.held[j]);
    }
  }
  if (!held.empty()) model.notes.push_back("joints that are not planned for are held: " + held);
}

}  // namespace corridor
