#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "collision/core/fault_list.h"
#include "planner/problem/problem.h"

namespace corridor {

/// What a robot file says: a rigid body, its meshes already relative to the reference point.
struct RobotFile {
  std::string name;
  RigidSpace space = RigidSpace::SE3;
  std::vector<ProblemMesh> shapes;
  double rotationWeight = 1;  ///< as Problem::rotationWeight
  std::vector<std::string> notes;
};

/// Reads a file of the format corridor-robot-1. Its faults, and those of its meshes, go to
/// `faults`; what could be read is returned all the same. nullopt: not even the robot's space is
/// known.
std::optional<RobotFile> readRobotFile(const std::filesystem::path& file, FaultList& faults);

}  // namespace corridor
