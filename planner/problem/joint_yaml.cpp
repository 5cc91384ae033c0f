#include "planner/problem/joint_yaml.h"

#include <cmath>

#include "collision/core/shortest.h"
#include "collision/core/spelling.h"
#include "planner/problem/keys.h"
#include "planner/robot/angles.h"

namespace corridor {
namespace {

/// Returns whether the entry is what YAML makes of the decimals in `{pan: 0,5}`: a key 5 without a
/// value.
bool hasDecimalComma(const YamlValue::Entry& entry) {
  return entry.value.kind == YamlValue::Kind::Null &&
         entry.key.find_first_not_of("0123456789") == entry.key.npos;
}

}  // namespace

std::string noSuchJoint(const std::string& name, const RobotDescription& model) {
  for (const LinkModel& link : model.links)
    if (link.name == name)
      return quotedWord(name) +
             " is a link, not a joint; poses of links are not supported: give the "
             "joints' values";
  std::vector<std::string> known;
  for (const JointModel& joint : model.joints)
    if (joint.type != JointType::fixed && !joint.mimic) known.push_back(joint.name);
  return "there is no joint " + quotedWord(name) + didYouMean(name, known) + knownWords(known);
}

std::string whyNotActive(const RobotDescription& model, std::size_t j) {
  const JointModel& joint = model.joints[j];
  if (joint.type == JointType::fixed) return "is fixed";
  if (joint.mimic)
    return "follows " + model.joints[joint.mimic->joint].name + " (mimic); give only that joint";
  return "";
}

std::string outsideLimits(double value, double lower, double upper, const std::string& angle) {
  return shortest(value) + " is outside of its limits, [" + shortest(lower) + ", " +
         shortest(upper) + "]" + (angle.empty() ? "" : degreesHint(value, lower, upper, angle));
}

std::string degreesHint(double value, double lower, double upper, const std::string& joint) {
  if (!fitsAsDegrees(value, lower, upper)) return "";
  return "; in degrees, write " + joint.substr(joint.rfind('/') + 1) + "_deg: " + shortest(value);
}

bool isJointValue(const RobotDescription& model, const std::string& key, const YamlValue& value) {
  double number = 0;
  return findJoint(model, key) && value.kind == YamlValue::Kind::Scalar &&
         parseNumber(value.text, Range::Any, number).empty();
}

void readJointValues(const YamlMap& map, const RobotDescription& model,
                     const std::function<void(std::size_t, const YamlValue::Entry&, bool)>& read,
                     const std::set<std::string>& others) {
  for (const YamlValue::Entry* entry : map.entries()) {
    const std::string& key = entry->key;
    if (others.contains(key) && !isJointValue(model, key, entry->value)) continue;
    if (const auto j = findJoint(model, key)) {
      read(*j, *entry, false);
      continue;
    }
    const bool degrees = key.ends_with("_deg");
    const std::string name = degrees ? key.substr(0, key.size() - 4) : key;
    const auto j = findJoint(model, name);
    if (!j)
      map.fault(key, noSuchJoint(name, model) +
                         (name == "pose" || name == "position" || name == "at"
                              ? "; poses of links are not supported: give the joints' values"
                          : hasDecimalComma(*entry) ? "; decimals need a point, not a comma"
                                                    : ""));
    else if (map.find(name))
      map.fault(key, "say " + name + " (radians) or " + key + " (degrees), not both");
    else if (const JointType type = model.joints[*j].type;
             type != JointType::revolute && type != JointType::continuous)
      map.fault(key,
                name + (type == JointType::prismatic ? " is prismatic; use " + name + ", in metres"
                                                     : " takes a pose, not one angle"));
    else
      read(*j, *entry, true);
  }
}

std::optional<PlanarOrSpatialPose> readJointPose(const YamlValue& value, const std::string& path,
                                                 const JointModel& joint, YamlSource& source,
                                                 std::vector<Note>& notes) {
  const bool spatial = joint.type == JointType::floating;
  return readPose(value, path,
                  {spatial, "joint " + joint.name + (spatial ? " is floating" : " is planar"),
                   &problemKeys().at("start.*")},
                  source, notes);
}

std::map<std::string, double> numbersOf(const JointModel& joint, const PlanarOrSpatialPose& pose) {
  const std::string in = joint.name + "/";
  std::map<std::string, double> numbers{{in + "x", pose.pose.p.x()}, {in + "y", pose.pose.p.y()}};
  if (joint.type == JointType::planar) {
    numbers[in + "yaw"] = pose.yaw;
    return numbers;
  }
  numbers[in + "z"] = pose.pose.p.z();
  numbers[in + "qx"] = pose.pose.q.x();
  numbers[in + "qy"] = pose.pose.q.y();
  numbers[in + "qz"] = pose.pose.q.z();
  numbers[in + "qw"] = pose.pose.q.w();
  return numbers;
}

}  // namespace corridor
