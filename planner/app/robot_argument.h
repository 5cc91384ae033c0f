#pragma once

#include <filesystem>
#include <string>

namespace corridor::app {

/// Returns whether a file is a `robot.yaml`. @throws InputError if it can't be read as YAML.
bool isRobotFile(const std::string& file);

/// Returns the robot of a folder: its robot.yaml, or else its only URDF. Returns "" for a folder
/// that contains a problem, and for anything that is not a folder.
/// @throws InputError if a folder contains neither a problem nor a robot.yaml, and has no URDF or
/// several.
std::string robotInFolder(const std::filesystem::path& folder);

}  // namespace corridor::app
