#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "planner/import/moveit_state.h"
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
/// orientations of links, goals that move a held joint or disagree with the rule of a mimic joint,
/// constraints of the path, and unknown keys. Fields that concern MoveIt's planners, and the
/// tolerances of goals, are ignored. All other fields with another value than messages have by
/// default are in a note.
class MoveitRequest {
 public:
  /// @throws InputError if the file is not YAML.
  MoveitRequest(const std::filesystem::path& file, FaultList& faults);

  /// Returns the name of the request's group, or "".
  std::string group();
  /// Holds joints that are not planned for at their values in the start state (`holdAt`).
  void hold(RobotSetup& setup);
  /// Reads the start, or the goals, of the only robot into the problem.
  void readStart(Problem& problem);
  void readGoals(Problem& problem);
  /// Returns the notes on the message. @pre All other members that read it were called.
  std::vector<Note> takeNotes(const Problem& problem);

 private:
  YamlMap root() { return {document_, "", nullptr, source_}; }
  /// Adds a fault for each held joint whose value in `values` differs from the value at which it is
  /// held, and for each unknown joint.
  void checkHeld(const std::map<std::string, double>& values, int line, const std::string& path,
                 const ModelRobot& robot);
  /// Adds a fault for each mimic joint whose value in `values` is not that of its rule at the goal
  /// `q`, and a note on the joints of `values` that have no value of their own.
  void checkFollowers(const std::map<std::string, double>& values, int line,
                      const std::string& path, const Configuration& q, const Problem& problem);

  YamlValue document_;
  YamlSource source_;
  std::optional<MoveitState> start_;
};

}  // namespace corridor
