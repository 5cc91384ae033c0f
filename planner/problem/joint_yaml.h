#pragma once

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "planner/problem/placement.h"
#include "planner/robot/joint_types.h"

/// Readers of maps of joint values, as in `start`, `goal`, `states`, `hold` and `bounds`.
namespace corridor {

/// Returns a message for an unknown joint, such as `there is no joint "pam" (did you mean "pan"?)`.
std::string noSuchJoint(const std::string& name, const RobotDescription& model);
/// Returns why a joint has no value of its own ("is fixed", "follows pan (mimic)"), or "" if it has
/// one.
std::string whyNotActive(const RobotDescription& model, std::size_t joint);
/// Returns the message for a value that is outside of its limits: "60 is outside of its limits,
/// [-2, 2]".
/// @param angle the joint's name if the value is an angle in radians, else "". With a name,
/// `degreesHint` is appended to the message.
std::string outsideLimits(double value, double lower, double upper, const std::string& angle = "");

/// If a value in radians is obviously meant in degrees (`fitsAsDegrees`), returns a hint: "; in
/// degrees, write pan_deg: 60". Otherwise returns "".
/// @param joint the joint's name, also with the robot's name before it: "left/pan".
std::string degreesHint(double value, double lower, double upper, const std::string& joint);

/// Returns whether a key of the format, such as `from`, is here a joint that is called so: its
/// value is a number.
bool isJointValue(const RobotDescription& model, const std::string& key, const YamlValue& value);

/// Calls `read` for each entry of the map whose key is a joint's name, or a joint's name followed
/// by "_deg" (then `degrees` is true). Adds a fault for every other key that is not in `others`.
void readJointValues(
    const YamlMap& map, const RobotDescription& model,
    const std::function<void(std::size_t joint, const YamlValue::Entry& entry, bool degrees)>& read,
    const std::set<std::string>& others = {});

/// Reads the pose of a planar or floating joint. Returns nullopt if a fault was added.
std::optional<PlanarOrSpatialPose> readJointPose(const YamlValue& value, const std::string& path,
                                                 const JointModel& joint, YamlSource& source,
                                                 std::vector<Note>& notes);

/// Returns the components of the pose of a planar or floating joint, by their names in states:
/// "base/x", "base/y", "base/yaw", or "body/x" … "body/qw".
std::map<std::string, double> numbersOf(const JointModel& joint, const PlanarOrSpatialPose& pose);

}  // namespace corridor
