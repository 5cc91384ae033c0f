#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "planner/problem/robot_file.h"

namespace corridor {

/// Reads a robot with joints: the keys of its robot.yaml, and the URDF and SRDF that it names.
/// Returns nullopt if one of them is faulted.
/// @param setup with `files` set.
std::optional<RobotSetup> readUrdfRobot(const YamlMap& map, const std::string& name,
                                        const std::filesystem::path& folder, RobotSetup setup);

/// Reads a URDF without a robot.yaml: all its moving joints are planned for. Returns nullopt if it
/// is faulted.
std::optional<RobotSetup> readBareUrdf(const std::filesystem::path& file, FaultList& faults);

/// A value beyond a limit by at most this is taken for the limit, with a note; rad or m. Limits and
/// values are often written with π rounded to four digits or more: 3.1416 is 7.4e-6 above π,
/// 3.14159 is 2.7e-6 below it.
inline constexpr double limitSlack = 1e-5;

/// Returns the value if it is in [lower, upper], the limit if it is beyond it by at most
/// `limitSlack` (with a note), or nullopt. The caller adds the fault.
/// @param path for the note: "start.pan".
std::optional<double> withinLimits(double value, double lower, double upper,
                                   const std::string& path, std::vector<std::string>& notes);

}  // namespace corridor
