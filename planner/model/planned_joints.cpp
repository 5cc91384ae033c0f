#include "planner/model/planned_joints.h"

#include <algorithm>
#include <string>

#include "collision/core/shortest.h"
#include "collision/core/spelling.h"
#include "planner/robot/joint_types.h"

namespace corridor {

bool canMove(const JointModel& joint) {
  return hasOwnValue(joint) && joint.lower != joint.upper;
}

std::vector<std::size_t> allMoving(const ModelRobot& robot) {
  std::vector<std::size_t> all;
  for (std::size_t j = 0; j < robot.description.joints.size(); ++j)
    if (canMove(robot.description.joints[j]) && !robot.description.joints[j].passive &&
        !robot.held.contains(j) && !robot.heldPoses.contains(j))
      all.push_back(j);
  return all;
}

std::string whyNoneMoves(const ModelRobot& robot) {
  const std::string none = "has no joint that can be planned for";
  std::vector<std::string> still;  // joints whose limits are equal
  double limit = 0;                // limit of the first joint in `still`
  bool isEqual = true;             // whether all joints in `still` have that limit
  bool isHeld = false, isPassive = false;
  const std::vector<JointModel>& joints = robot.description.joints;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (!hasOwnValue(joints[j])) continue;
    if (canMove(joints[j])) {
      (joints[j].passive ? isPassive : isHeld) = true;
      continue;
    }
    if (still.empty()) limit = joints[j].lower;
    isEqual = isEqual && joints[j].lower == limit;
    still.push_back(joints[j].name);
  }
  if (isHeld) return none + ", except those in hold";
  if (isPassive) return none + ", except passive ones; joints: [NAME, …] plans for these";
  if (!still.empty())
    return none + ": " + joinedFirst(still) + ": lower = upper" +
           (isEqual ? " = " + shortest(limit) : "");
  return none +
         "; for a vehicle, add a planar or floating joint on an empty link to the URDF, or use "
         "rigid: SE3 in a robot.yaml";
}

std::string heldText(const ModelRobot& robot) {
  std::string text;
  for (std::size_t j = 0; j < robot.description.joints.size(); ++j) {
    const auto held = robot.held.find(j);
    const auto pose = robot.heldPoses.find(j);
    if ((held == robot.held.end() && pose == robot.heldPoses.end()) || robot.heldByFile.contains(j))
      continue;
    text += (text.empty() ? "" : ", ") + robot.description.joints[j].name + " ";
    if (held != robot.held.end())
      text += shortest(held->second);
    else if (const RigidPose& X = pose->second;
             X.p.isZero(0) && X.q.coeffs() == Eigen::Quaterniond::Identity().coeffs())
      text += "not moved";
    else
      text +=
          "at [" + shortest(X.p.x()) + ", " + shortest(X.p.y()) + ", " + shortest(X.p.z()) + "]";
  }
  return text;
}

void chooseJoints(ModelRobot& robot, const std::vector<std::size_t>& active) {
  robot.planned = active;
  const RobotDescription& model = robot.description;
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const JointModel& joint = model.joints[j];
    if (!hasOwnValue(joint) || robot.held.contains(j) || robot.heldPoses.contains(j) ||
        std::find(active.begin(), active.end(), j) != active.end())
      continue;
    if (isPoseJoint(joint.type))
      robot.heldPoses[j] = {};
    else
      robot.held[j] =
          joint.type == JointType::continuous ? 0.0 : std::clamp(0.0, joint.lower, joint.upper);
  }
}

}  // namespace corridor
