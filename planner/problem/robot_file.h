#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "collision/core/fault_list.h"
#include "planner/problem/problem.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {

/// The content of a robot's file, while a problem is read and before a model is built.
struct RobotSetup {
  ModelRobot robot;
  std::vector<std::filesystem::path> files;  ///< the robot's file, then the files that it names
};

/// The purpose of reading a robot's file.
enum class RobotUse {
  plan,     ///< to plan: if no joint can move, this is a fault
  describe  ///< to describe the robot: if no joint can move, a note says so
};

/// Reads a file of the format corridor-robot-1, or a bare URDF. The faults of this file, and of the
/// files that it names, are added to `faults`. Returns nullopt in these cases: the file can't be
/// read as YAML or has another format; it has neither or both of `rigid` and `urdf`; a rigid robot
/// has no legal value of `rigid`; `readUrdfRobot` or `readBareUrdf` returns nullopt. A rigid robot
/// is returned even if shapes have faults; these shapes are left out.
/// @param group the group that is planned for if the file has an SRDF, but neither `group` nor
/// `joints`. Empty: no group.
/// @param notesOfFaulty gets the notes if the result is nullopt; otherwise the notes are in
/// `robot.description` of the result.
/// @param cache see `readProblem`
std::optional<RobotSetup> readRobotFile(const std::filesystem::path& file, FaultList& faults,
                                        std::vector<Note>& notesOfFaulty,
                                        const std::string& group = "",
                                        RobotUse use = RobotUse::plan, FileCache* cache = nullptr);

/// Reads a robot's file that is not part of a problem. @throws NotedInputError with all faults.
/// @param cache see `readProblem`.
RobotSetup readRobotAlone(const std::filesystem::path& file, RobotUse use = RobotUse::plan,
                          FileCache* cache = nullptr);

}  // namespace corridor
