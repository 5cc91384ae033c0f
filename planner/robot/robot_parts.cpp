#include "planner/robot/robot_parts.h"

#include <cmath>
#include <set>
#include <unordered_map>

#include "collision/core/spelling.h"
#include "planner/robot/joint_types.h"
#include "planner/robot/urdf_outline.h"

namespace corridor {
namespace {

using PartsJoint = RobotParts::Joint;

bool isRanged(JointType type) {
  return type == JointType::revolute || type == JointType::prismatic;
}

/// Checks the parts, and describes their links and joints in the form that `checkUrdfTree` and
/// `resolveMimics` take.
class PartsCheck {
 public:
  PartsCheck(const RobotParts& parts, RobotFaults& faults) : parts_(parts), faults_(faults) {
    for (const LinkModel& link : parts.links) linkNames_.push_back(link.name);
    for (const PartsJoint& joint : parts.joints) {
      jointNames_.push_back(joint.name);
      types_.emplace(joint.name, joint.type);
    }
  }

  UrdfOutline outline() {
    if (parts_.links.empty()) faults_.fault(0, "it has no link; at least one is needed");
    UrdfOutline result;
    for (std::size_t i = 0; i < parts_.links.size(); ++i)
      if (isNewName("link", i, parts_.links[i].name, links_))
        result.links.push_back({parts_.links[i].name, 0, {}});
      else
        result.complete = false;
    for (std::size_t j = 0; j < parts_.joints.size(); ++j)
      if (isNewName("joint", j, parts_.joints[j].name, joints_))
        result.joints.push_back(jointOutline(parts_.joints[j]));
      else
        result.complete = false;
    for (const LinkModel& link : parts_.links) checkShapes(link);
    for (const auto& pair : parts_.allow) checkAllow(pair);
    return result;
  }

 private:
  void checkShapes(const LinkModel& link) {
    for (const PlacedShape& shape : link.shapes) {
      bool finite = true;
      forEachPoint(shape, [&](const Vec3& p, double) { finite &= p.allFinite(); });
      if (const auto wrong = shape.primitive ? checkPrimitive(*shape.primitive) : std::nullopt)
        faults_.fault(0, owned("link", link.name) + ": " + *wrong);
      else if (!finite)
        faults_.fault(0, owned("link", link.name) + ": the numbers of its shapes must be finite");
    }
  }

  bool isNewName(const char* kind, std::size_t index, const std::string& name,
                 std::set<std::string>& names) {
    if (name.empty())
      faults_.fault(0, std::string(kind) + " number " + std::to_string(index) + " has no name");
    else if (!names.insert(name).second)
      faults_.fault(0, owned(kind, name) + " is already defined; names must be unique");
    else
      return true;
    return false;
  }

  UrdfJoint jointOutline(const PartsJoint& joint) {
    const std::string owner = owned("joint", joint.name);
    UrdfJoint result;
    result.name = joint.name;
    result.type = joint.type;
    result.parent = joint.parent;
    result.child = joint.child;
    if (joint.parent.empty()) faults_.fault(0, owner + " has no parent");
    if (joint.child.empty()) faults_.fault(0, owner + " has no child");
    if (!joint.X_PJ.p.allFinite() || !joint.X_PJ.q.coeffs().allFinite())
      faults_.fault(0, owner + ": the numbers of its origin must be finite");
    else if (joint.X_PJ.q.coeffs().isZero(0))
      faults_.fault(0, owner + ": the quaternion of its origin is zero");
    if (joint.type != JointType::fixed && joint.type != JointType::floating) {
      if (!joint.axis.allFinite())
        faults_.fault(0, owner + ": the numbers of its axis must be finite");
      else if (joint.axis == Vec3::Zero())
        faults_.fault(0, owner + ": its axis is zero; a direction is needed, such as (0, 0, 1)");
    }
    result.limit = limitOf(joint, owner);
    if (joint.velocity && !(*joint.velocity > 0 && std::isfinite(*joint.velocity)))
      faults_.fault(0, owner + ": its velocity must be a finite number above 0");
    result.mimic = mimicOf(joint, owner);
    // A fault of the mimic was reported. These limits prevent a second fault, that the joint has
    // none.
    if (joint.mimic && !result.mimic && isRanged(joint.type) && !result.limit)
      result.limit = UrdfLimit{0.0, 0.0, {}, 0};
    return result;
  }

  std::optional<UrdfLimit> limitOf(const PartsJoint& joint, const std::string& owner) {
    UrdfLimit limit{0.0, 0.0, {}, 0};  // the result after a fault; it causes no further fault
    if (!isRanged(joint.type)) {
      if (joint.lower || joint.upper)
        faults_.fault(0, owner + " is " + nameOf(joint.type) +
                             "; only revolute and prismatic joints have limits");
      return std::nullopt;
    }
    if (!joint.lower && !joint.upper && joint.mimic) return std::nullopt;
    if (!joint.lower || !joint.upper)
      faults_.fault(0, owner + ": a lower and an upper limit are needed" +
                           (joint.type == JointType::revolute
                                ? "; a joint without limits is of type continuous"
                                : ""));
    else if (!std::isfinite(*joint.lower) || !std::isfinite(*joint.upper))
      faults_.fault(0, owner + ": its limits must be finite" +
                           (joint.type == JointType::revolute
                                ? "; a joint without limits is of type continuous"
                                : ""));
    else
      limit.lower = joint.lower, limit.upper = joint.upper;
    return limit;
  }

  std::optional<UrdfMimic> mimicOf(const PartsJoint& joint, const std::string& owner) {
    if (!joint.mimic) return std::nullopt;
    const std::string& leader = joint.mimic->joint;
    const auto found = types_.find(leader);
    if (!std::isfinite(joint.mimic->multiplier) || !std::isfinite(joint.mimic->offset))
      faults_.fault(0, owner + ": the numbers of its mimic must be finite");
    else if (joint.type == JointType::fixed)
      faults_.fault(0, owner + " is fixed, and can't mimic another joint");
    else if (found == types_.end())
      faults_.fault(0, owner + " mimics " + quotedWord(leader) +
                           ", which is not a joint of this robot" + hint(leader, jointNames_));
    else if (found->second == JointType::fixed || isPoseJoint(found->second))
      faults_.fault(0, owner + " mimics " + quotedWord(leader) + ", which is " +
                           nameOf(found->second) + ", not a joint of one variable");
    else
      return UrdfMimic{leader, joint.mimic->multiplier, joint.mimic->offset, 0};
    return std::nullopt;
  }

  void checkAllow(const std::array<std::string, 2>& pair) {
    for (const std::string& name : pair)
      if (!links_.contains(name))
        faults_.fault(0, "allow: " + quotedWord(name) + " is not a link of this robot" +
                             hint(name, linkNames_));
    if (pair[0] == pair[1])
      faults_.fault(0, "allow: two links are needed, not " + quotedWord(pair[0]) + " twice");
  }

  std::string hint(const std::string& name, const std::vector<std::string>& known) const {
    return faults_.hints() ? didYouMean(name, known) : "";
  }

  const RobotParts& parts_;
  RobotFaults& faults_;
  std::vector<std::string> linkNames_, jointNames_;
  std::unordered_map<std::string, JointType> types_;
  std::set<std::string> links_, joints_;
};

JointModel modelOf(const PartsJoint& joint,
                   const std::unordered_map<std::string, std::size_t>& links) {
  JointModel model;
  model.name = joint.name;
  model.type = joint.type;
  model.parent = links.at(joint.parent);
  model.child = links.at(joint.child);
  model.X_PJ = joint.X_PJ;
  if (joint.type != JointType::fixed && joint.type != JointType::floating)
    model.axis = scaledAxis(joint.axis);
  if (isRanged(joint.type)) {
    model.lower = joint.lower.value_or(0);  // not given: a mimic, whose own limits don't count
    model.upper = joint.upper.value_or(0);
  }
  if (joint.velocity && joint.type != JointType::fixed && !isPoseJoint(joint.type))
    model.velocity = *joint.velocity;
  return model;
}

}  // namespace

std::optional<RobotDescription> makeRobot(RobotParts parts, std::vector<Fault>& faults) {
  RobotFaults found(robotLabel(parts.name));
  std::vector<Note> notes;
  const UrdfOutline outline = PartsCheck(parts, found).outline();
  const std::vector<std::size_t> order = checkUrdfTree(outline, found);
  const std::vector<std::optional<Mimic>> mimics = resolveMimics(outline, found, notes);
  const bool sound = found.sound();
  for (Fault& fault : found.takeFaults()) faults.push_back(std::move(fault));
  if (!sound) return std::nullopt;
  RobotDescription model;
  model.name = parts.name;
  model.notes = std::move(notes);
  std::unordered_map<std::string, std::size_t> links;
  for (std::size_t i = 0; i < parts.links.size(); ++i) links[parts.links[i].name] = i;
  model.links = std::move(parts.links);
  for (const std::size_t j : order) model.joints.push_back(modelOf(parts.joints[j], links));
  finishRobot(order, mimics, model);
  for (const auto& [a, b] : parts.allow) model.allowed.push_back({a, b, "allow"});
  return model;
}

}  // namespace corridor
