#pragma once

#include <filesystem>
#include <string>

namespace corridor::app {

/// What a command can be given.
enum class InputKind { robot, problem, mesh };

/// Returns what a file or folder is. @param file not a folder of a robot (`robotInFolder`).
/// @throws InputError for an SRDF, or if a YAML file can't be read.
InputKind inputKindOf(const std::string& file);

/// Returns the robot of a folder: its robot.yaml, or else its only URDF. Returns "" for a folder
/// that contains a problem, and for anything that is not a folder.
/// @throws InputError if a folder contains neither a problem nor a robot.yaml, and has no URDF or
/// several.
std::string robotInFolder(const std::filesystem::path& folder);

}  // namespace corridor::app
