#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "collision/core/fault_list.h"
#include "planner/problem/problem.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {

/// A robot while a problem is read: what its file says, before a model is built.
struct RobotSetup {
  ModelRobot robot;
  std::vector<std::filesystem::path> files;  ///< the robot's file, then all that it names
};

/// Reads a file of the format corridor-robot-1, or a bare URDF. Its faults, and those of the files
/// that it names, go to `faults`. Returns nullopt if the robot is not known well enough to read its
/// start. A rigid robot is returned without the shapes that have faults.
std::optional<RobotSetup> readRobotFile(const std::filesystem::path& file, FaultList& faults);

}  // namespace corridor
