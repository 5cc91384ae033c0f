#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "planner/import/moveit_poses.h"
#include "planner/problem/robot_file.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {

/// A message moveit_msgs/RobotState: the state of one robot. Some content is a fault, because a
/// proof would be wrong if this content were ignored: attached objects. Efforts, headers and the
/// speeds of joints with several variables have no effect. Velocities are not read.
struct MoveitState {
  std::string path;                      ///< of the message, for messages: "start_state"
  int line = 0;                          ///< of the message
  bool isSound = true;                   ///< no fault was added
  std::map<std::string, double> values;  ///< by the joints' names; rad or m
  std::vector<MessagePose> poses = {};   ///< of planar and floating joints, and of the base
};

/// Reads the robot state that is the value of a key. Returns nullopt if the key is absent or its
/// value is empty. If the state is a difference to another one (`is_diff: true`), adds a note to
/// the map's source.
std::optional<MoveitState> readMoveitState(const YamlMap& message, std::string_view key);

/// Holds each joint that is not planned for at its value in a state. Skips joints without a value
/// in the state, and joints whose value is in the robot's `hold`; a note names those whose value
/// differs. Adds a note on names that are no joints, and on mimic joints that are off their rule.
/// Adds a fault to `source` for a value outside the joint's limits.
/// @param origin the message, as the source of the held values: "start_state of the request".
void holdAt(const MoveitState& state, const std::string& origin, const YamlSource& source,
            RobotSetup& setup);

/// Returns the values of the planned joints of the only robot. Returns nullopt if a fault was added
/// to `source`: for a missing value, or one outside the limits.
std::optional<Configuration> plannedValues(const MoveitState& state, const YamlSource& source,
                                           Problem& problem);

/// Compares a state with the problem that was read. Adds a note if the problem's start has other
/// values of planned joints than the state, by more than `limitSlack`. A pose in the state that
/// differs from the problem's is a note if the user gave the problem's pose, or else a fault.
/// @pre the problem's start was read without a fault.
void compareWithProblem(const MoveitState& state, const Problem& problem, YamlSource& source);

}  // namespace corridor
