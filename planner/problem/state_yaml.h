#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "planner/problem/problem.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {

/// Reads states of a problem, as in `start` and `goal`. A state is a configuration of all robots
/// together.
class StateReader {
 public:
  /// All arguments must outlive the object.
  /// @param problem the problem; its model must be set, with the bounds that its file gives.
  StateReader(Problem& problem, YamlSource& source) : problem_(problem), source_(source) {}

  /// Returns the configuration, or nullopt after adding a fault.
  /// @param path the value's place in the file, for messages: "start", "goal[1]".
  /// @param others legal keys that another reader reads: "within".
  std::optional<Configuration> read(const YamlValue& value, const std::string& path,
                                    const std::set<std::string>& others = {});

  /// Returns whether the problem has one robot, given by `robot: …`. The states of such a problem
  /// contain no robot names.
  bool isAlone() const { return robots().size() == 1 && robots().front().name.empty(); }

 private:
  struct Given;
  const std::vector<ModelRobot>& robots() const { return problem_.model.robots; }
  bool readRobot(std::size_t robot, const YamlValue& value, const std::string& path,
                 const std::set<std::string>& others, Configuration& q);
  bool readRigid(std::size_t robot, const YamlValue& value, const std::string& path,
                 const std::set<std::string>& others, Configuration& q);
  bool fromNamed(std::size_t robot, const std::string& name, int line, const std::string& path,
                 Given& given);
  /// Compares a named state with the values of held joints. Adds a note for each joint whose values
  /// differ. There is one exception: for a goal, the difference is a fault unless the robot's
  /// `hold` gives the held value.
  bool checkHeld(std::size_t robot, const NamedState& state, const std::string& name, int line,
                 const std::string& path);
  bool readJoints(std::size_t robot, const YamlMap& map, Given& given,
                  const std::set<std::string>& others);
  bool apply(std::size_t robot, const Given& given, int line, const std::string& path,
             Configuration& q);
  bool setSingle(const PlannedJoint& planned, double value, int line, const std::string& path,
                 Configuration& q);
  bool isInBounds(const PlannedJoint& planned, const Configuration& q, int line,
                  const std::string& path) const;

  Problem& problem_;
  YamlSource& source_;
};

/// Whether a message may advise to write degrees, by the key `…_deg`. Only values in maps of YAML
/// have this key; messages of MoveIt and sets of MotionBenchMaker do not.
enum class DegreesHint { none, key };

/// Returns the value to store in a coordinate. The angle of a circle coordinate (a continuous
/// joint, or a yaw) is brought into (−π, π]. If the value of a line coordinate is beyond a limit by
/// at most `limitSlack`, it is replaced by the limit. Each of these changes adds a note. If the
/// value of a line coordinate is farther outside of its limits, returns nullopt and sets `why`.
/// @param path the value's place in the file, for the note and for `why`.
std::optional<double> coordinateValue(const Coordinate& coordinate, double value,
                                      const std::string& path, std::vector<Note>& notes,
                                      std::string& why, DegreesHint hint = DegreesHint::none);

}  // namespace corridor
