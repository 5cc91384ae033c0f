#pragma once

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "planner/problem/placement.h"
#include "planner/robot/robot_model.h"

/// Maps of joint values, as `start`, `goal`, `states` and `hold` have them.
namespace corridor {

std::optional<std::size_t> findJoint(const RobotModel& model, const std::string& name);

/// Planar and floating joints: they take a pose, {at: …, yaw_deg: …}.
bool isWhole(JointType type);

/// For messages: `there is no joint "pam"; did you mean "pan"?`.
std::string noSuchJoint(const std::string& name, const RobotModel& model);
/// Why a joint has no value of its own ("is fixed", "follows pan (mimic)"), or "".
std::string whyNotActive(const RobotModel& model, std::size_t joint);
std::string outsideLimits(double value, double lower, double upper);

/// Calls `read` for each entry of the map whose key is a joint, or a joint and "_deg" (degrees),
/// and faults all other keys but those of `others`.
void readJointValues(
    const YamlMap& map, const RobotModel& model,
    const std::function<void(std::size_t joint, const YamlValue::Entry& entry, bool degrees)>& read,
    const std::set<std::string>& others = {});

/// The pose of a planar or floating joint. nullopt: faulted.
std::optional<PlanarOrSpatialPose> readJointPose(const YamlValue& value, const std::string& path,
                                                 const JointModel& joint, YamlSource& source,
                                                 std::vector<std::string>& notes);

/// Its numbers, by their names in states: "base/x", "base/y", "base/yaw"; "body/x" … "body/qw".
std::map<std::string, double> numbersOf(const JointModel& joint, const PlanarOrSpatialPose& pose);

}  // namespace corridor
