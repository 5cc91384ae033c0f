#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "planner/problem/problem.h"
#include "planner/problem/robot_file.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {

/// A message moveit_msgs/MotionPlanRequest, written as YAML. The members read parts of the message,
/// and add faults to the problem's list.
///
/// The members read the group, the start state, and goals that are joint values. Some content is a
/// fault, because the resulting path would be wrong if this content were ignored: attached objects,
/// poses of joints with several variables that are not the identity, goals that are positions or
/// orientations of links, goals that move a held joint, constraints of the path, and unknown keys.
/// All other fields, and the tolerances of goals, are ignored.
class MoveitRequest {
 public:
  /// @throws InputError if the file is not YAML.
  MoveitRequest(const std::filesystem::path& file, FaultList& faults);

  /// Returns the name of the request's group, or "".
  std::string group();
  /// For each joint of the robot that is not planned for: holds the joint at its value in the start
  /// state. Skips joints without a value in the start state, and joints whose value is in the
  /// robot's `hold`.
  void hold(RobotSetup& setup);
  /// Reads the start, or the goals, of the only robot into the problem.
  void readStart(Problem& problem);
  void readGoals(Problem& problem);

 private:
  YamlMap root() { return {document_, "", nullptr, source_}; }
  /// Reads the values of the planned joints. Returns nullopt if a fault was added.
  std::optional<Configuration> read(const std::map<std::string, double>& values, int line,
                                    const std::string& path, Problem& problem);

  /// Adds a fault for each held joint whose value in `values` differs from the value at which it is
  /// held, and for each unknown joint.
  void checkHeld(const std::map<std::string, double>& values, int line, const std::string& path,
                 const ModelRobot& robot);

  YamlValue document_;
  YamlSource source_;
  std::map<std::string, double> start_;  // values in the start state, by joint
  int startLine_ = 0;
  bool startIsRead_ = false;  // whether the start state was read without a fault
};

}  // namespace corridor
