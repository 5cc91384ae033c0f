#pragma once

#include <filesystem>

#include "planner/model/model_builder.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {

/// A message moveit_msgs/PlanningScene, written as YAML. Its parts are read by the members, which
/// add faults to the problem's list.
///
/// Read are the collision objects (primitives and meshes) and the allowed collision matrix. Faults,
/// because a plan without them would be wrong, are attached objects, planes, octomaps, padded or
/// scaled links, and objects on other frames than the world and the robot's root. Everything else
/// is ignored. Unknown keys are faults.
class MoveitScene {
 public:
  /// @throws InputError if the file is not YAML.
  MoveitScene(const std::filesystem::path& file, FaultList& faults);

  /// Adds the collision objects. Each object is an obstacle. Objects on the robot's root are moved
  /// by its base.
  void addWorld(const ModelRobot& robot, ModelBuilder& builder);
  /// Excludes pairs of bodies from the tests as the allowed collision matrix says. As in MoveIt, a
  /// matrix replaces the SRDF's pairs. Its default entries are not read; their pairs are tested.
  void applyAllowed(Model& model);
  /// Returns notes on a scene that seems to be of another robot.
  std::vector<std::string> notesOn(const Model& model);

 private:
  YamlMap root() { return {document_, "", nullptr, source_}; }

  YamlValue document_;
  YamlSource source_;
};

}  // namespace corridor
