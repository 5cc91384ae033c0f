#include "planner/model/limits.h"

#include <algorithm>
#include <cmath>

#include "collision/core/shortest.h"
#include "collision/core/spelling.h"
#include "planner/model/model.h"
#include "planner/robot/joint_types.h"

namespace corridor {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();

/// Returns the limits of `first`, and those of `second` for members that `first` leaves unset.
LimitValues orElse(const LimitValues& first, const LimitValues& second) {
  return {first.velocity ? first.velocity : second.velocity,
          first.acceleration ? first.acceleration : second.acceleration,
          first.jerk ? first.jerk : second.jerk};
}

/// Applies the limits of a user to a model. See limitsOf.
class Limits {
 public:
  Limits(const Model& model, const LimitSpec& spec) : model_(model), spec_(spec) {
    const auto size = static_cast<Eigen::Index>(model.space.size());
    limits_.velocity = limits_.acceleration = limits_.jerk = Configuration::Constant(size, kNone);
  }

  JointLimits make() {
    for (const LimitedJoint& joint : jointsWithLimits(model_))
      if (!joint.isMimic) addJoint(joint);
    for (const LimitedJoint& joint : jointsWithLimits(model_))
      if (joint.isMimic) addMimic(joint);
    for (const CoordinateGroup& group : model_.space.groups())
      if (group.kind != CoordinateGroup::Kind::joints) addPose(group);
    if (!assumed_.empty())
      limits_.notes.push_back("limits: no acceleration is given for " + joinedFirst(assumed_) +
                              "; " + shortest(kAssumedAcceleration) + " rad/s² or m/s² is assumed" +
                              (spec_.accelerationScale < 1 ? ", before scaling" : ""));
    limits_.velocity *= spec_.velocityScale;
    limits_.acceleration *= spec_.accelerationScale;
    for (const auto& [link, speed] : spec_.links) addLink(link, speed);
    return std::move(limits_);
  }

 private:
  void set(std::size_t number, const std::string& name, const LimitValues& values, double urdf) {
    const auto i = static_cast<Eigen::Index>(number);
    limits_.velocity[i] = std::min(values.velocity.value_or(kNone), urdf);
    limits_.acceleration[i] = values.acceleration.value_or(kAssumedAcceleration);
    limits_.jerk[i] = values.jerk.value_or(kNone);
    if (!values.acceleration) assumed_.push_back(name);
  }

  void addJoint(const LimitedJoint& joint) {
    const auto found = spec_.named.find(joint.name);
    const LimitValues named = found == spec_.named.end() ? LimitValues{} : found->second;
    const LimitValues others =
        joint.isPrismatic ? orElse(spec_.slides, spec_.joints) : spec_.joints;
    set(joint.number, joint.name, orElse(named, others), named.velocity ? kNone : joint.velocity);
    if (named.velocity && *named.velocity > joint.velocity)
      limits_.notes.push_back("limits: the velocity of " + joint.name + ", " +
                              shortest(*named.velocity) + ", is above the URDF's " +
                              shortest(joint.velocity));
  }

  void addMimic(const LimitedJoint& joint) {
    const auto found = spec_.named.find(joint.name);
    if (found == spec_.named.end()) return;
    const auto i = static_cast<Eigen::Index>(joint.number);
    const double factor = std::abs(joint.multiplier);
    const auto narrow = [&](double& limit, const std::optional<double>& value) {
      if (value) limit = std::min(limit, *value / factor);
    };
    narrow(limits_.velocity[i], found->second.velocity);
    narrow(limits_.acceleration[i], found->second.acceleration);
    narrow(limits_.jerk[i], found->second.jerk);
  }

  void addPose(const CoordinateGroup& group) {
    const auto& coordinates = model_.space.coordinates();
    set(coordinates[group.coordinates.front()].first, group.name + " (position)", spec_.position,
        kNone);
    set(coordinates[group.coordinates.back()].first, group.name + " (rotation)", spec_.rotation,
        kNone);
  }

  void addLink(const std::string& name, double speed) {
    for (const ModelRobot& robot : model_.robots) {
      for (std::size_t l = 0; l < robot.linkFrames.size(); ++l) {
        const std::string link = robot.description.links[l].name;
        if ((robot.name.empty() ? link : robot.name + "/" + link) != name) continue;
        LinkSpeed limit{name, robot.linkFrames[l], speed, {Vec3::Zero()}};
        for (const ModelBody& body : model_.bodies)
          if (body.robot && &model_.robots[*body.robot] == &robot && body.frame == limit.frame)
            addPoints(body, limit);
        limits_.links.push_back(std::move(limit));
      }
    }
  }

  /// Adds to `limit` the corners of one box around all shapes of a body.
  static void addPoints(const ModelBody& body, LinkSpeed& limit) {
    Eigen::AlignedBox3d box;
    for (const PlacedShape& shape : body.shapes)
      forEachPoint(shape, [&](const Vec3& p, double radius) {
        box.extend(p + Vec3::Constant(radius));
        box.extend(p - Vec3::Constant(radius));
      });
    if (box.isEmpty()) return;
    for (int corner = 0; corner < 8; ++corner)
      limit.points.push_back(box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)));
  }

  const Model& model_;
  const LimitSpec& spec_;
  JointLimits limits_;
  std::vector<std::string> assumed_;
};

}  // namespace

std::vector<LimitedJoint> jointsWithLimits(const Model& model) {
  std::vector<LimitedJoint> joints;
  for (const ModelRobot& robot : model.robots) {
    const std::string prefix = robot.name.empty() ? "" : robot.name + "/";
    for (const JointModel& joint : robot.description.joints) {
      if (joint.type == JointType::fixed || isPoseJoint(joint.type)) continue;
      const JointModel& leader = joint.mimic ? robot.description.joints[joint.mimic->joint] : joint;
      if (joint.mimic && joint.mimic->multiplier == 0) continue;
      for (const PlannedJoint& planned : robot.plannedJoints)
        if (!planned.name.empty() && planned.name == leader.name)
          joints.push_back({prefix + joint.name, joint.name,
                            model.space.coordinates()[planned.coordinate].first,
                            joint.mimic ? joint.mimic->multiplier : 1, joint.mimic.has_value(),
                            joint.type == JointType::prismatic, joint.velocity});
    }
  }
  return joints;
}

JointLimits limitsOf(const Model& model, const LimitSpec& spec) {
  return Limits(model, spec).make();
}

}  // namespace corridor
