#pragma once

#include <optional>
#include <string>
#include <vector>

#include "planner/problem/robot_file.h"
#include "planner/problem/yaml_reader.h"

/// Readers of the values of joints that are not planned for.
namespace corridor {

/// A key in a file, for messages.
struct YamlPlace {
  const YamlSource& source;
  std::string path;  ///< the path of the key: "hold", "start"
  int line = 0;
};

/// Reads the key `hold` of a robot's file: sets the held values of joints in `setup`. Returns the
/// name of the state that `hold` refers to (`hold: NAME` or `from: NAME`), or nullopt.
std::optional<std::string> readHold(const YamlMap& file, RobotSetup& setup);

/// Holds each joint at its value in a named state. Skips joints that the state does not contain,
/// and the joints in `planned` and in the robot's `heldByFile`.
void holdState(const std::string& state, const std::vector<std::size_t>& planned,
               const YamlPlace& place, RobotSetup& setup);

/// For each robot whose start is a named state, or is based on one (`from`), holds the joints at
/// their values in this state. Joints that are planned for, and joints to which the robot's `hold`
/// gives a value, are left as they are.
void holdAsStart(const YamlMap& problem, std::vector<RobotSetup>& robots);

/// Returns the state with this name. If there is no such state, or if it can't be used, adds a
/// fault and returns nullptr.
const NamedState* findState(const RobotDescription& model, const std::string& name,
                            const YamlPlace& place);

/// Returns the pose of a planar or floating joint in a state, or nullopt if the state has no pose
/// for this joint.
std::optional<RigidPose> poseIn(const NamedState& state, const JointModel& joint);

}  // namespace corridor
