#include "planner/problem/assembly.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "planner/problem/joint_yaml.h"

namespace corridor {
namespace {

using Kind = Coordinate::Kind;
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

class RobotAssembly {
 public:
  RobotAssembly(RobotSetup& setup, bool alone, Problem& problem)
      : setup_(setup),
        model_(setup.robot.model),
        prefix_(setup.robot.name.empty() ? "" : setup.robot.name + "/"),
        alone_(alone),
        problem_(problem) {}

  void run() {
    if (setup_.isRigid()) addWhole("", model_.mount);
    for (const std::size_t j : setup_.active) addJoint(j);
    setup_.robot.linkFrames.assign(model_.links.size(), 0);
    addRoot();
    for (std::size_t j = 0; j < model_.joints.size(); ++j) addFrames(j);
    addBodies();
    for (const std::string& note : model_.notes)
      problem_.notes.push_back(alone_ ? note : setup_.robot.name + ": " + note);
    for (const auto& file : setup_.files)
      if (std::find(problem_.files.begin(), problem_.files.end(), file) == problem_.files.end())
        problem_.files.push_back(file);
  }

  std::vector<std::size_t> jointCoordinates;

 private:
  double weightOf(const std::string& joint) const {
    const auto found = setup_.jointWeights.find(joint);
    return found == setup_.jointWeights.end() ? 1 : found->second;
  }

  /// Adds the coordinates of a planar or floating joint, or of a rigid robot (`joint` is empty).
  void addWhole(const std::string& joint, JointType type) {
    const std::string in = prefix_ + (joint.empty() ? "" : joint + "/");
    const bool planar = type == JointType::planar;
    const double weight = weightOf(joint);
    CoordinateGroup group;
    group.kind = planar ? CoordinateGroup::Kind::planar : CoordinateGroup::Kind::floating;
    group.name = joint.empty() ? (alone_ ? model_.name : setup_.robot.name) : prefix_ + joint;
    for (const char* axis : planar ? std::vector{"x", "y"} : std::vector{"x", "y", "z"})
      group.coordinates.push_back(
          problem_.space.add({Kind::line, in + axis, 0, unknown, unknown, false, weight}));
    // The space measures a rotation by its quaternion's angle, half the rotation angle: hence 2 ×.
    group.coordinates.push_back(problem_.space.add(
        planar ? Coordinate{Kind::circle, in + "yaw", 0, -pi, pi, true, setup_.rotationWeight}
               : Coordinate{Kind::rotation, in + "rotation", 0, 0, 0, true,
                            2 * setup_.rotationWeight}));
    setup_.freedoms.push_back({joint, type, group.coordinates.front()});
    problem_.space.addGroup(std::move(group));
  }

  void addJoint(std::size_t j) {
    const JointModel& joint = model_.joints[j];
    if (isWhole(joint.type)) return addWhole(joint.name, joint.type);
    Coordinate coordinate{
        Kind::line,          prefix_ + joint.name, 0,
        joint.lower,         joint.upper,          joint.type != JointType::prismatic,
        weightOf(joint.name)};
    if (joint.type == JointType::continuous) {
      coordinate.kind = Kind::circle;
      coordinate.lower = -pi;
      coordinate.upper = pi;
    }
    setup_.freedoms.push_back({joint.name, joint.type, problem_.space.add(coordinate)});
    jointCoordinates.push_back(setup_.freedoms.back().coordinate);
  }

  const DegreeOfFreedom* freedomOf(const std::string& joint) const {
    const auto found =
        std::find_if(setup_.freedoms.begin(), setup_.freedoms.end(),
                     [&](const DegreeOfFreedom& freedom) { return freedom.name == joint; });
    return found == setup_.freedoms.end() ? nullptr : &*found;
  }
  std::size_t variableOf(std::size_t coordinate) const {
    return problem_.space.coordinates()[coordinate].first;
  }

  std::size_t addFrame(const std::string& name, std::size_t parent, const RigidPose& fixed,
                       Frame::Joint joint = Frame::Joint::none) {
    Frame frame;
    frame.name = name;
    frame.parent = parent;
    frame.fixed = fixed;
    frame.joint = joint;
    return problem_.tree.add(std::move(frame));
  }

  /// Adds the frames of a planar or floating joint: a translation, then a rotation.
  /// @returns the frame of the link that the joint moves.
  std::size_t addWholeFrames(const std::string& name, const DegreeOfFreedom& freedom,
                             std::size_t parent, const RigidPose& X_PJ, const Vec3& axis) {
    const bool planar = freedom.type == JointType::planar;
    const Eigen::Quaterniond plane = planar ? fromZ(axis) : Eigen::Quaterniond::Identity();
    const std::size_t first = variableOf(freedom.coordinate);
    const std::size_t shift =
        addFrame(prefix_ + (freedom.name.empty() ? "position" : freedom.name), parent,
                 X_PJ * RigidPose{Vec3::Zero(), plane}, Frame::Joint::translation);
    problem_.tree.frames[shift].variable = first;
    problem_.tree.frames[shift].count = planar ? 2 : 3;
    const std::size_t turn = addFrame(name, shift, {Vec3::Zero(), plane.conjugate()},
                                      planar ? Frame::Joint::revolute : Frame::Joint::rotation);
    problem_.tree.frames[turn].variable = first + (planar ? 2 : 3);
    problem_.tree.frames[turn].axis = axis;
    return turn;
  }

  /// Returns the pose of the child link in the parent link of a planar or floating joint that is
  /// held at `pose`.
  static RigidPose heldAt(const JointModel& joint, const RigidPose& pose) {
    if (joint.type == JointType::floating) return joint.X_PJ * pose;
    const Eigen::Quaterniond plane = fromZ(joint.axis);
    return joint.X_PJ * RigidPose{Vec3::Zero(), plane} * pose *
           RigidPose{Vec3::Zero(), plane.conjugate()};
  }

  void addRoot() {
    const std::string name = prefix_ + model_.links[model_.root].name;
    setup_.robot.linkFrames[model_.root] =
        setup_.isRigid()
            ? addWholeFrames(alone_ ? model_.name : setup_.robot.name, setup_.freedoms.front(), 0,
                             setup_.robot.base, Vec3::UnitZ())
            : addFrame(name, 0, setup_.robot.base);
  }

  void addFrames(std::size_t j) {
    const JointModel& joint = model_.joints[j];
    const std::string name = prefix_ + model_.links[joint.child].name;
    const std::size_t parent = setup_.robot.linkFrames[joint.parent];
    std::size_t& child = setup_.robot.linkFrames[joint.child];
    if (joint.type == JointType::fixed) {
      child = addFrame(name, parent, joint.X_PJ);
    } else if (isWhole(joint.type)) {
      const DegreeOfFreedom* freedom = freedomOf(joint.name);
      child = freedom ? addWholeFrames(name, *freedom, parent, joint.X_PJ, joint.axis)
                      : addFrame(name, parent, heldAt(joint, setup_.heldPoses.at(j)));
    } else {
      child = addFrame(
          name, parent, joint.X_PJ,
          joint.type == JointType::prismatic ? Frame::Joint::prismatic : Frame::Joint::revolute);
      drive(problem_.tree.frames[child], j);
    }
  }

  void drive(Frame& frame, std::size_t j) {
    const JointModel& joint = model_.joints[j];
    frame.axis = joint.axis;
    const std::size_t source = joint.mimic ? joint.mimic->joint : j;
    const double multiplier = joint.mimic ? joint.mimic->multiplier : 1;
    frame.offset = joint.mimic ? joint.mimic->offset : 0;
    const DegreeOfFreedom* freedom = freedomOf(model_.joints[source].name);
    if (freedom && multiplier != 0) {
      frame.variable = variableOf(freedom->coordinate);
      frame.multiplier = multiplier;
    } else if (!freedom) {
      const double held = setup_.held.at(source);
      frame.offset = joint.mimic ? multiplier * held + frame.offset : held;
    }
  }

  void addBodies() {
    for (std::size_t l = 0; l < model_.links.size(); ++l) {
      LinkModel& link = model_.links[l];
      if (link.shapes.empty()) continue;
      ProblemBody body;
      body.name = setup_.isRigid() && !alone_ ? setup_.robot.name : prefix_ + link.name;
      body.frame = setup_.robot.linkFrames[l];
      body.robot = problem_.robots.size();
      body.shapes = std::move(link.shapes);
      link.shapes.clear();
      for (PlacedShape& shape : body.shapes)
        if (shape.name.starts_with(link.name))
          shape.name = body.name + shape.name.substr(link.name.size());
      problem_.bodies.push_back(std::move(body));
    }
  }

  RobotSetup& setup_;
  RobotModel& model_;
  const std::string prefix_;
  const bool alone_;
  Problem& problem_;
};

}  // namespace

void assembleRobots(std::vector<RobotSetup>& robots, Problem& problem) {
  CoordinateGroup joints;
  for (RobotSetup& setup : robots) {
    RobotAssembly assembly(setup, setup.robot.name.empty(), problem);
    assembly.run();
    joints.coordinates.insert(joints.coordinates.end(), assembly.jointCoordinates.begin(),
                              assembly.jointCoordinates.end());
    problem.robots.push_back(std::move(setup.robot));
  }
  if (!joints.coordinates.empty()) problem.space.addGroup(std::move(joints));
}

void addObstacle(Problem& problem, std::string name, std::vector<PlacedShape> shapes) {
  if (shapes.empty()) return;
  problem.bodies.push_back({std::move(name), 0, std::nullopt, std::move(shapes)});
}

bool hasWholes(const Problem& problem) {
  const auto& groups = problem.space.groups();
  return std::any_of(groups.begin(), groups.end(), [](const CoordinateGroup& group) {
    return group.kind != CoordinateGroup::Kind::joints;
  });
}

bool hasJoints(const Problem& problem) {
  const auto& groups = problem.space.groups();
  return std::any_of(groups.begin(), groups.end(), [](const CoordinateGroup& group) {
    return group.kind == CoordinateGroup::Kind::joints;
  });
}

void setTube(const TubeSpec& asked, Problem& problem) {
  constexpr double rounding = 0x1p-40;
  problem.tube = Configuration::Zero(static_cast<Eigen::Index>(problem.space.size()));
  for (const CoordinateGroup& group : problem.space.groups()) {
    double longest = 0;
    for (const std::size_t i : group.coordinates) {
      const Coordinate& c = problem.space.coordinates()[i];
      if (c.kind == Kind::line) longest = std::max(longest, c.upper - c.lower);
    }
    const bool whole = group.kind != CoordinateGroup::Kind::joints;
    for (const std::size_t i : group.coordinates) {
      const Coordinate& c = problem.space.coordinates()[i];
      const bool line = c.kind == Kind::line;
      const double range = !line ? 2 * pi : whole ? longest : c.upper - c.lower;
      const auto& wanted = !whole ? asked.joints : line ? asked.position : asked.rotation;
      problem.tube[static_cast<Eigen::Index>(c.first)] =
          std::max(wanted.value_or(0), rounding * range);
    }
  }
}

}  // namespace corridor
