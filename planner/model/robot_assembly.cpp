#include "planner/model/robot_assembly.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "planner/robot/joint_types.h"

namespace corridor {
namespace {

using CoordinateKind = Coordinate::Kind;
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr double pi = std::numbers::pi;

RigidPose operator*(const RigidPose& a, const RigidPose& b) {
  return {a.p + a.q.normalized() * b.p, a.q * b.q};
}

/// Returns the smallest rotation that takes z to `axis`. A planar joint translates in x and y of
/// the rotated frame.
Eigen::Quaterniond fromZ(const Vec3& axis) {
  const Vec3 n = axis.stableNormalized();
  if (n.x() == 0 && n.y() == 0)
    return n.z() > 0 ? Eigen::Quaterniond::Identity() : Eigen::Quaterniond(0, 1, 0, 0);
  return Eigen::Quaterniond(1 + n.z(), -n.y(), n.x(), 0).normalized();
}

/// Moves one robot into a model. See assembleRobot.
class RobotAssembly {
 public:
  RobotAssembly(ModelRobot& robot, Model& model)
      : robot_(robot),
        description_(robot.description),
        alone_(robot.name.empty()),
        prefix_(alone_ ? "" : robot.name + "/"),
        model_(model) {}

  void run() {
    if (robot_.isRigid()) addPoseJoint("", description_.mount);
    for (const std::size_t j : robot_.planned) addJoint(j);
    robot_.linkFrames.assign(description_.links.size(), 0);
    addRoot();
    for (std::size_t j = 0; j < description_.joints.size(); ++j) addFrames(j);
    addBodies();
  }

  std::vector<std::size_t> jointCoordinates;  // of the single joints, in the order of `planned`

 private:
  double weightOf(const std::string& joint) const {
    const auto found = robot_.jointWeights.find(joint);
    return found == robot_.jointWeights.end() ? 1 : found->second;
  }

  /// Adds the coordinates of a planar or floating joint, or of a rigid robot (`joint` is empty).
  void addPoseJoint(const std::string& joint, JointType type) {
    const std::string in = prefix_ + (joint.empty() ? "" : joint + "/");
    const bool planar = type == JointType::planar;
    const double weight = weightOf(joint);
    CoordinateGroup group;
    group.kind = planar ? CoordinateGroup::Kind::planar : CoordinateGroup::Kind::floating;
    group.name = joint.empty() ? (alone_ ? description_.name : robot_.name) : prefix_ + joint;
    for (const char* axis : planar ? std::vector{"x", "y"} : std::vector{"x", "y", "z"})
      group.coordinates.push_back(
          model_.space.add({CoordinateKind::line, in + axis, 0, unknown, unknown, false, weight}));
    // For a `rotation`, the space's distance measures the quaternion angle, which is half the
    // rotation angle. So the weight is doubled.
    group.coordinates.push_back(
        model_.space.add(planar ? Coordinate{CoordinateKind::circle, in + "yaw", 0, -pi, pi, true,
                                             robot_.rotationWeight}
                                : Coordinate{CoordinateKind::rotation, in + "rotation", 0, 0, 0,
                                             true, 2 * robot_.rotationWeight}));
    robot_.plannedJoints.push_back({joint, type, group.coordinates.front()});
    model_.space.addGroup(std::move(group));
  }

  void addJoint(std::size_t j) {
    const JointModel& joint = description_.joints[j];
    if (isPoseJoint(joint.type)) return addPoseJoint(joint.name, joint.type);
    Coordinate coordinate{
        CoordinateKind::line, prefix_ + joint.name, 0,
        joint.lower,          joint.upper,          joint.type != JointType::prismatic,
        weightOf(joint.name)};
    if (joint.type == JointType::continuous) {
      coordinate.kind = CoordinateKind::circle;
      coordinate.lower = -pi;
      coordinate.upper = pi;
    }
    robot_.plannedJoints.push_back({joint.name, joint.type, model_.space.add(coordinate)});
    jointCoordinates.push_back(robot_.plannedJoints.back().coordinate);
  }

  const PlannedJoint* plannedJointOf(const std::string& joint) const {
    const auto found =
        std::find_if(robot_.plannedJoints.begin(), robot_.plannedJoints.end(),
                     [&](const PlannedJoint& planned) { return planned.name == joint; });
    return found == robot_.plannedJoints.end() ? nullptr : &*found;
  }
  std::size_t variableOf(std::size_t coordinate) const {
    return model_.space.coordinates()[coordinate].first;
  }

  std::size_t addFrame(const std::string& name, std::size_t parent, const RigidPose& fixed,
                       Frame::Joint joint = Frame::Joint::none) {
    Frame frame;
    frame.name = name;
    frame.parent = parent;
    frame.fixed = fixed;
    frame.joint = joint;
    return model_.tree.add(std::move(frame));
  }

  /// Adds the frames of a planar or floating joint: a translation, then a rotation.
  /// @returns the frame of the link that the joint moves.
  std::size_t addPoseFrames(const std::string& name, const PlannedJoint& planned,
                            std::size_t parent, const RigidPose& X_PJ, const Vec3& axis) {
    const bool planar = planned.type == JointType::planar;
    const Eigen::Quaterniond plane = planar ? fromZ(axis) : Eigen::Quaterniond::Identity();
    const std::size_t first = variableOf(planned.coordinate);
    const std::size_t shift =
        addFrame(prefix_ + (planned.name.empty() ? "position" : planned.name), parent,
                 X_PJ * RigidPose{Vec3::Zero(), plane}, Frame::Joint::translation);
    model_.tree.frames[shift].variable = first;
    model_.tree.frames[shift].count = planar ? 2 : 3;
    const std::size_t turn = addFrame(name, shift, {Vec3::Zero(), plane.conjugate()},
                                      planar ? Frame::Joint::revolute : Frame::Joint::rotation);
    model_.tree.frames[turn].variable = first + (planar ? 2 : 3);
    model_.tree.frames[turn].axis = axis;
    return turn;
  }

  /// Returns the pose of a joint's child link in its parent link. @pre the joint is planar or
  /// floating, and held at `pose`.
  static RigidPose heldAt(const JointModel& joint, const RigidPose& pose) {
    return joint.X_PJ * poseInJointFrame(joint, pose);
  }

  void addRoot() {
    const std::string name = prefix_ + description_.links[description_.root].name;
    robot_.linkFrames[description_.root] =
        robot_.isRigid()
            ? addPoseFrames(alone_ ? description_.name : robot_.name, robot_.plannedJoints.front(),
                            0, robot_.base, Vec3::UnitZ())
            : addFrame(name, 0, robot_.base);
  }

  void addFrames(std::size_t j) {
    const JointModel& joint = description_.joints[j];
    const std::string name = prefix_ + description_.links[joint.child].name;
    const std::size_t parent = robot_.linkFrames[joint.parent];
    std::size_t& child = robot_.linkFrames[joint.child];
    if (joint.type == JointType::fixed) {
      child = addFrame(name, parent, joint.X_PJ);
    } else if (isPoseJoint(joint.type)) {
      const PlannedJoint* planned = plannedJointOf(joint.name);
      child = planned ? addPoseFrames(name, *planned, parent, joint.X_PJ, joint.axis)
                      : addFrame(name, parent, heldAt(joint, robot_.heldPoses.at(j)));
    } else {
      child = addFrame(
          name, parent, joint.X_PJ,
          joint.type == JointType::prismatic ? Frame::Joint::prismatic : Frame::Joint::revolute);
      drive(model_.tree.frames[child], j);
    }
  }

  void drive(Frame& frame, std::size_t j) {
    const JointModel& joint = description_.joints[j];
    frame.axis = joint.axis;
    const std::size_t source = joint.mimic ? joint.mimic->joint : j;
    const double multiplier = joint.mimic ? joint.mimic->multiplier : 1;
    frame.offset = joint.mimic ? joint.mimic->offset : 0;
    const PlannedJoint* planned = plannedJointOf(description_.joints[source].name);
    if (planned && multiplier != 0) {
      frame.variable = variableOf(planned->coordinate);
      frame.multiplier = multiplier;
    } else if (!planned) {
      const double held = robot_.held.at(source);
      frame.offset = joint.mimic ? multiplier * held + frame.offset : held;
    }
  }

  void addBodies() {
    for (std::size_t l = 0; l < description_.links.size(); ++l) {
      LinkModel& link = description_.links[l];
      if (link.shapes.empty()) continue;
      ModelBody body;
      body.name = robot_.isRigid() && !alone_ ? robot_.name : prefix_ + link.name;
      body.frame = robot_.linkFrames[l];
      body.robot = model_.robots.size();
      body.shapes = std::move(link.shapes);
      link.shapes.clear();
      for (PlacedShape& shape : body.shapes)
        if (shape.name.starts_with(link.name))
          shape.name = body.name + shape.name.substr(link.name.size());
      model_.bodies.push_back(std::move(body));
    }
  }

  ModelRobot& robot_;
  RobotDescription& description_;
  const bool alone_;
  const std::string prefix_;
  Model& model_;
};

}  // namespace

RigidPose poseInJointFrame(const JointModel& joint, const RigidPose& state) {
  if (joint.type == JointType::floating) return state;
  const Eigen::Quaterniond plane = fromZ(joint.axis);
  return RigidPose{Vec3::Zero(), plane} * state * RigidPose{Vec3::Zero(), plane.conjugate()};
}

std::vector<std::size_t> assembleRobot(ModelRobot robot, Model& model) {
  RobotAssembly assembly(robot, model);
  assembly.run();
  model.robots.push_back(std::move(robot));
  return assembly.jointCoordinates;
}

}  // namespace corridor
