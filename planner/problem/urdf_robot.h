#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "planner/problem/robot_file.h"

namespace corridor {

/// A robot of joints: what robot.yaml says of it, and the URDF and SRDF that it names.
/// @param setup with `file` and `files` set. nullopt: faulted.
std::optional<RobotSetup> readUrdfRobot(const YamlMap& map, const std::string& name,
                                        const std::filesystem::path& folder, RobotSetup setup);

/// A URDF without more: all its moving joints are planned for, adjacent links aren't tested.
std::optional<RobotSetup> readBareUrdf(const std::filesystem::path& file, FaultList& faults);

/// Sets the joints that are planned for, and holds all others at 0, or at the value nearest to it
/// within their limits; that is noted.
void chooseJoints(RobotSetup& setup, const std::vector<std::size_t>& active);

/// Moves by itself: not fixed, not a mimic.
bool movesItself(const JointModel& joint);

/// Values so little beyond a limit are taken for it, with a note: limits and values are written
/// with π rounded to four digits or more (3.1416 is 7.4e-6 above it, 3.14159 2.7e-6 below). Rad or
/// m.
inline constexpr double limitSlack = 1e-5;

/// A value that is within [lower, upper], or was so but for rounding.
/// @param path for the note: "start.pan". nullopt: it is not, and that is for the caller to tell.
std::optional<double> withinLimits(double value, double lower, double upper,
                                   const std::string& path, std::vector<std::string>& notes);

}  // namespace corridor
