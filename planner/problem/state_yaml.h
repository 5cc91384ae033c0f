#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "planner/problem/robot_file.h"

namespace corridor {

/// Reads states of all robots of a problem, as `start` and `goal` write them.
class StateReader {
 public:
  /// All must outlive the object. @param problem assembled, its explicit bounds set.
  StateReader(const std::vector<RobotSetup>& robots, Problem& problem, YamlSource& source)
      : robots_(robots), problem_(problem), source_(source) {}

  /// @param path of the value, for messages: "start", "goal[1]".
  /// @param others keys that are not for this reader: "within".
  /// nullopt: faulted.
  std::optional<Configuration> read(const YamlValue& value, const std::string& path,
                                    const std::set<std::string>& others = {});

  /// One robot, whose states are not under its name.
  bool isAlone() const { return robots_.size() == 1 && problem_.robots.front().name.empty(); }

 private:
  struct Given;
  bool readRobot(std::size_t robot, const YamlValue& value, const std::string& path,
                 const std::set<std::string>& others, Configuration& q);
  bool readRigid(std::size_t robot, const YamlValue& value, const std::string& path,
                 const std::set<std::string>& others, Configuration& q);
  bool fromNamed(std::size_t robot, const std::string& name, int line, const std::string& path,
                 Given& given);
  bool readJoints(std::size_t robot, const YamlMap& map, Given& given,
                  const std::set<std::string>& others);
  bool apply(std::size_t robot, const Given& given, int line, const std::string& path,
             Configuration& q);
  bool setSingle(const Freedom& freedom, double value, int line, const std::string& path,
                 Configuration& q);
  bool isInBounds(const Freedom& freedom, const Configuration& q, int line,
                  const std::string& path) const;

  const std::vector<RobotSetup>& robots_;
  Problem& problem_;
  YamlSource& source_;
};

/// A value as it is stored in a coordinate: a circle's wrapped into (−π, π], a line's within its
/// limits, or so but for rounding; both with a note. @param path for the note and for `why`.
/// nullopt: outside of the limits; `why` says it.
std::optional<double> coordinateValue(const Coordinate& coordinate, double value,
                                      const std::string& path, std::vector<std::string>& notes,
                                      std::string& why);

}  // namespace corridor
