#pragma once

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>

#include "planner/problem/robot_file.h"

namespace corridor {

/// Reads a robot with joints: the keys of its robot.yaml, and the URDF and SRDF that it names.
/// Returns nullopt if the URDF or SRDF has a fault, or if a key that concerns the joints has one
/// (`states`, `hold`, `allow`, `never_in_contact`, `weights`, `group`, `joints`). Faults of other
/// keys are only added to the map's source.
/// @param group see readRobotFile.
/// @param notesOfFaulty see readRobotFile.
/// @param setup has only `files` set, with the robot.yaml. The other members are set in the result.
std::optional<RobotSetup> readUrdfRobot(const YamlMap& map, const std::string& name,
                                        const std::string& group,
                                        const std::filesystem::path& folder, RobotUse use,
                                        RobotSetup setup, std::vector<Note>& notesOfFaulty);

/// Reads a URDF without a robot.yaml: all its moving joints are planned for. Returns nullopt if the
/// URDF has a fault, or if `use` is `plan` and no joint can move. @param notesOfFaulty see
/// readRobotFile. @param cache see readProblem.
std::optional<RobotSetup> readBareUrdf(const std::filesystem::path& file, RobotUse use,
                                       FaultList& faults, std::vector<Note>& notesOfFaulty,
                                       FileCache* cache);

/// The slack of limits, rad or m. A value that exceeds a limit by at most `limitSlack` is replaced
/// by the limit, with a note. Limits and values are often written with π rounded to four decimals
/// or more: 3.1416 is 7.4e-6 above π, 3.14159 is 2.7e-6 below π.
inline constexpr double limitSlack = 1e-5;

/// The reason of pairs that `allow` of the robot's file lists.
inline constexpr std::string_view kAllowedByRobot = "robot.yaml: allow";

/// Returns how far a value may be from another value that it must equal: 2^-50·max(1, |value|), in
/// the unit of the value. The pose of a joint at a held value is stored as a quaternion or a
/// translation, whose rounding has this order. The difference covers a value in degrees that
/// another program converted to radians.
inline double equalUpToRounding(double value) {
  return 0x1p-50 * std::max(1.0, std::abs(value));
}

/// Returns the value if it is in [lower, upper]. If it is beyond a limit by at most `limitSlack`,
/// returns the limit and adds a note. Otherwise returns nullopt; the caller adds the fault.
/// @param path the value's path in the file, for the note: "start.pan".
std::optional<double> withinLimits(double value, double lower, double upper,
                                   const std::string& path, std::vector<Note>& notes);

}  // namespace corridor
