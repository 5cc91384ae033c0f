#include "planner/model/held_joints.h"

#include <algorithm>
#include <map>

#include "collision/core/spelling.h"
#include "planner/model/planned_joints.h"

namespace corridor {
namespace {

/// Returns the joints from a body's link up to the root of its robot, the lowest first. Returns no
/// joint for an obstacle.
std::vector<std::size_t> jointsAbove(const Model& model, const ModelBody& body) {
  std::vector<std::size_t> above;
  if (!body.robot) return above;
  const ModelRobot& robot = model.robots[*body.robot];
  const auto at = std::find(robot.linkFrames.begin(), robot.linkFrames.end(), body.frame);
  auto link = static_cast<std::size_t>(at - robot.linkFrames.begin());
  const std::vector<JointModel>& joints = robot.description.joints;
  for (std::size_t j = joints.size(); j-- > 0;)  // parents come before children
    if (joints[j].child == link) {
      above.push_back(j);
      link = joints[j].parent;
    }
  return above;
}

}  // namespace

bool couldMove(const RobotDescription& robot, std::size_t joint) {
  const JointModel& own = robot.joints[joint];
  if (own.type == JointType::fixed) return false;
  if (own.mimic) return own.mimic->multiplier != 0 && canMove(robot.joints[own.mimic->joint]);
  return canMove(own);
}

std::vector<std::size_t> fixedPartsOf(const Model& model) {
  std::map<std::size_t, std::size_t> partOfFrame;  // of the frames of links
  for (const ModelRobot& robot : model.robots) {
    const std::vector<std::size_t>& frames = robot.linkFrames;
    const std::size_t root = frames[robot.description.root];
    partOfFrame[root] = robot.isRigid() ? root : 0;
    for (std::size_t j = 0; j < robot.description.joints.size(); ++j) {
      const JointModel& joint = robot.description.joints[j];
      const std::size_t child = frames[joint.child];
      partOfFrame[child] =
          couldMove(robot.description, j) ? child : partOfFrame.at(frames[joint.parent]);
    }
  }
  std::vector<std::size_t> parts;
  for (const ModelBody& body : model.bodies)
    parts.push_back(body.robot ? partOfFrame.at(body.frame) : 0);
  return parts;
}

std::vector<std::string> jointsBetween(const Model& model, std::size_t a, std::size_t b) {
  const ModelBody &bodyA = model.bodies[a], &bodyB = model.bodies[b];
  std::vector<std::size_t> aboveA = jointsAbove(model, bodyA), aboveB = jointsAbove(model, bodyB);
  if (bodyA.robot == bodyB.robot)
    while (!aboveA.empty() && !aboveB.empty() && aboveA.back() == aboveB.back()) {
      aboveA.pop_back();  // above both bodies, so not between them
      aboveB.pop_back();
    }
  std::vector<std::string> names;
  const auto addNames = [&](const ModelBody& body, const std::vector<std::size_t>& joints) {
    for (auto j = joints.rbegin(); j != joints.rend(); ++j) {
      const ModelRobot& robot = model.robots[*body.robot];
      if (!couldMove(robot.description, *j)) continue;
      const auto& mimic = robot.description.joints[*j].mimic;
      const std::string name = (robot.name.empty() ? "" : robot.name + "/") +
                               robot.description.joints[mimic ? mimic->joint : *j].name;
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
  };
  addNames(bodyA, aboveA);
  addNames(bodyB, aboveB);
  return names;
}

std::string adviceAtRest(const Model& model, std::size_t a, std::size_t b) {
  std::vector<std::string> joints;
  for (const std::string& joint : jointsBetween(model, a, b)) joints.push_back(quotedWord(joint));
  const bool isOne = joints.size() == 1;
  return std::string(isOne ? "the joint" : "the joints") + " between them, " +
         joinedFirst(joints, 3) + ", " + (isOne ? "is" : "are") + " held; hold " +
         (isOne ? "it at another value" : "them at other values") + ", or add allow: [[" +
         model.bodies[a].name + ", " + model.bodies[b].name + "]] if this is intended";
}

}  // namespace corridor
