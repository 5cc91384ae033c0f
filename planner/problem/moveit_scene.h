#pragma once

#include <filesystem>

#include "planner/model/model_builder.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {

/// A message moveit_msgs/PlanningScene, written as YAML. The members read its parts, and add faults
/// to the problem's list.
///
/// They read the collision objects (primitives and meshes) and the allowed collision matrix. A plan
/// without the following would be wrong, so they are faults: attached objects, planes, octomaps,
/// padded or scaled links, objects on other frames than the world and the robot's root, and unknown
/// keys. All other fields are ignored.
class MoveitScene {
 public:
  /// @throws InputError if the file is not YAML.
  MoveitScene(const std::filesystem::path& file, FaultList& faults);

  /// Adds the collision objects. Each object is an obstacle. The robot's base moves the objects
  /// that are given in the frame of its root.
  /// @param root the name of the robot's root link.
  void addWorld(const std::string& root, const RigidPose& base, ModelBuilder& builder);
  /// Excludes pairs of bodies from the tests as the allowed collision matrix says. As in MoveIt, a
  /// matrix replaces the SRDF's pairs. Its default entries are not read; their pairs are tested.
  void applyAllowed(Model& model);
  /// Returns notes on a scene that seems to be of another robot.
  std::vector<Note> notesOn(const Model& model);

 private:
  YamlMap message() { return {document_, "", nullptr, source_}; }

  YamlValue document_;
  YamlSource source_;
};

}  // namespace corridor
