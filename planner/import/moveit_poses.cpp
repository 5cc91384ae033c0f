#include "planner/import/moveit_poses.h"

#include <algorithm>
#include <cmath>

#include "collision/core/shortest.h"
#include "collision/core/spelling.h"
#include "planner/model/robot_assembly.h"
#include "planner/problem/joint_yaml.h"
#include "planner/problem/placement.h"
#include "planner/problem/urdf_robot.h"
#include "planner/robot/joint_types.h"

namespace corridor {
namespace {

const MapKeys kPoses{{"header", "joint_names", "transforms", "twist", "wrench"}, {}};
const MapKeys kTransform{{"translation", "rotation"}, {}};
const MapKeys kHeaderKeys{{"seq", "stamp", "frame_id"}, {}};

/// Returns the state of a planar or floating joint, or of a rigid robot, in a configuration.
RigidPose poseIn(const Configuration& q, const PlannedJoint& planned,
                 const ConfigurationSpace& space) {
  const auto first = static_cast<Eigen::Index>(space.coordinates()[planned.coordinate].first);
  if (planned.type == JointType::planar)
    return {Vec3(q[first], q[first + 1], 0), fromRpy(Vec3(0, 0, q[first + 2])).q};
  return {q.segment<3>(first), Eigen::Quaterniond(Eigen::Vector4d(q.segment<4>(first + 3)))};
}

/// A pose in the model.
struct OwnPose {
  RigidPose pose;
  std::string isAt;  ///< "the base is at "
  std::string fix;
  bool isChosen = false, isPlanned = false;
};

/// Returns the model's pose for the name of a joint in a message, or nullopt if there is none.
std::optional<OwnPose> ownPoseOf(const std::string& name, const Model& model,
                                 const Configuration& q, const std::string& configuration) {
  const auto planned = [&](const RigidPose& pose) {
    return OwnPose{pose, "the " + configuration + " is at ", "give it by start in the problem",
                   true, true};
  };
  const auto hasJoint = [&](const ModelRobot& robot) {
    return findJoint(robot.description, name).has_value();
  };
  const bool isUnique = std::count_if(model.robots.begin(), model.robots.end(), hasJoint) == 1;
  for (const ModelRobot& robot : model.robots)
    for (std::size_t j = 0; j < robot.description.joints.size(); ++j) {
      const JointModel& joint = robot.description.joints[j];
      const std::string full = robot.name.empty() ? joint.name : robot.name + "/" + joint.name;
      if (name != full && !(isUnique && name == joint.name)) continue;
      if (!isPoseJoint(joint.type)) return std::nullopt;
      for (const PlannedJoint& one : robot.plannedJoints)
        if (one.name == full) return planned(poseInJointFrame(joint, poseIn(q, one, model.space)));
      return OwnPose{poseInJointFrame(joint, robot.heldPoses.at(j)), "the joint is held at ",
                     "give it by hold in the robot's file", robot.heldByFile.contains(j)};
    }
  if (model.robots.size() != 1) return std::nullopt;
  const ModelRobot& robot = model.robots.front();
  if (robot.isRigid()) return planned(poseIn(q, robot.plannedJoints.front(), model.space));
  return OwnPose{robot.base, "the base is at ", "give it by base in the problem",
                 !isSamePose(robot.base, {})};
}

}  // namespace

std::string written(const RigidPose& pose) {
  const auto list = [](const auto& numbers) {
    std::string text;
    for (const double number : numbers) text += (text.empty() ? "[" : ", ") + shortest(number);
    return text + "]";
  };
  return "{at: " + list(pose.p) + ", quat_xyzw: " + list(pose.q.coeffs()) + "}";
}

std::string frameOf(const YamlMap& message) {
  const YamlValue* const header = message.find("header");
  if (!header || header->kind == YamlValue::Kind::Null) return "";
  const YamlMap map(*header, message.pathOf("header"), &kHeaderKeys, message.source());
  map.ignore({"seq", "stamp"});
  return map.textOrNone("frame_id");
}

std::optional<Eigen::Quaterniond> readQuaternion(const YamlMap& map, const char* key) {
  const auto numbers = readNamed(map, key, {"x", "y", "z", "w"});
  if (!numbers) return std::nullopt;
  const std::vector<double>& n = *numbers;
  const Eigen::Quaterniond q(n[3], n[0], n[1], n[2]);
  if (!q.coeffs().isZero(0)) return ofOrdinarySize(q);
  map.source().notes.push_back({map.pathOf(key) +
                                    ": a quaternion of zeros, the default of messages, is read as "
                                    "no rotation (MoveIt's rule)",
                                NoteWeight::motion});
  return Eigen::Quaterniond::Identity();
}

std::optional<RigidPose> readTransform(const YamlValue& value, const std::string& path,
                                       YamlSource& source) {
  const YamlMap map(value, path, &kTransform, source);
  RigidPose pose;
  const std::size_t before = source.faults.size();
  if (const auto p = readNamed(map, "translation", {"x", "y", "z"}))
    pose.p = Vec3((*p)[0], (*p)[1], (*p)[2]);
  if (const auto q = readQuaternion(map, "rotation")) pose.q = *q;
  return source.faults.size() == before ? std::optional(pose) : std::nullopt;
}

std::vector<MessagePose> readMessagePoses(const YamlMap& state) {
  std::vector<MessagePose> poses;
  const YamlValue* const value = state.find("multi_dof_joint_state");
  if (!value || value->kind == YamlValue::Kind::Null) return poses;
  YamlSource& source = state.source();
  const YamlMap map(*value, state.pathOf("multi_dof_joint_state"), &kPoses, source);
  map.ignore({"wrench"});
  const auto transforms = itemsOf(map, "transforms");
  std::vector<std::string> names;
  if (const YamlValue* const list = map.find("joint_names"))
    names =
        readWords(*list, "such as [base_joint]", map.pathOf("joint_names"), source).value_or(names);
  if (names.size() != transforms.size())
    map.fault("transforms", "one transform for each of the joint_names is needed, " +
                                std::to_string(names.size()) + ", not " +
                                std::to_string(transforms.size()));
  for (std::size_t i = 0; i < std::min(names.size(), transforms.size()); ++i) {
    const auto pose = readTransform(*transforms[i], map.pathOf("transforms"), source);
    if (pose)
      poses.push_back({map.pathOf("transforms") + ": " + quotedWord(names[i]), transforms[i]->line,
                       names[i], *pose});
  }
  const std::string frame = frameOf(map);
  if (!poses.empty() && !frame.empty() && frame != "world")
    source.notes.push_back({source.file + ": " + map.pathOf("header.frame_id") +
                                ": the poses are compared as poses in the world, not in " +
                                quotedWord(frame),
                            NoteWeight::coverage});
  return poses;
}

bool isSamePose(const RigidPose& a, const RigidPose& b, double slack) {
  const double largest = b.p.cwiseAbs().maxCoeff();
  const auto isSame = [&](double x, double y, double size) {
    return std::abs(x - y) <= std::max(slack, 2 * equalUpToRounding(size));
  };
  for (int i = 0; i < 3; ++i)
    if (!isSame(a.p[i], b.p[i], largest)) return false;
  const Eigen::Quaterniond p = a.q.normalized(), q = b.q.normalized();
  const double sign = p.dot(q) < 0 ? -1 : 1;
  for (int i = 0; i < 4; ++i)
    if (!isSame(p.coeffs()[i], sign * q.coeffs()[i], 1)) return false;
  return true;
}

std::optional<PoseConflict> conflictOf(const MessagePose& given, const Model& model,
                                       const Configuration& q, const std::string& configuration) {
  const auto own = ownPoseOf(given.joint, model, q, configuration);
  if (!own)
    return PoseConflict{given.path + ": no pose in this problem belongs to this name",
                        "remove it from the message"};
  if (isSamePose(given.pose, own->pose)) return std::nullopt;
  return PoseConflict{given.path + ": " + own->isAt + written(own->pose) + ", not at " +
                          written(given.pose) + " as here",
                      own->fix, own->isChosen,
                      own->isPlanned && isSamePose(given.pose, own->pose, limitSlack)};
}

}  // namespace corridor
