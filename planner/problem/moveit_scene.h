#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "planner/model/model_builder.h"
#include "planner/model/task.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {

/// A message moveit_msgs/PlanningScene, written as YAML. The members read parts of the message, and
/// add faults to the problem's list.
///
/// The members read the collision objects (primitives and meshes), the octomap, the allowed
/// collision matrix and the paddings of links. Some content is a fault, because the resulting path
/// would be wrong if this content were ignored: attached objects, planes, scaled links, objects in
/// a frame other than the world's or that of the robot's root link, and unknown keys. All other
/// fields are ignored.
class MoveitScene {
 public:
  /// @throws InputError if the file is not YAML.
  MoveitScene(const std::filesystem::path& file, FaultList& faults);

  /// Adds each collision object, and the octomap, as an obstacle. Objects in the frame of the
  /// robot's root link are placed relative to the robot's base.
  /// @param root the name of the robot's root link.
  void addWorld(const std::string& root, const RigidPose& base, ModelBuilder& builder);
  /// If the scene has an allowed collision matrix with names, excludes the pairs of bodies that the
  /// matrix allows to touch. As in MoveIt, the matrix then replaces the SRDF's pairs. The default
  /// entries of the matrix are not read, so pairs that only a default entry allows are tested.
  void applyAllowed(Model& model);
  /// Returns the paddings of links (metres). As in MoveIt, they apply to pairs of a link and an
  /// obstacle.
  /// @pre `addWorld` was called.
  Padding paddingOf(const Model& model) const;
  /// Returns notes if the scene names another robot, or if its paddings or its matrix name links or
  /// bodies that the model does not have.
  std::vector<Note> notesOn(const Model& model);

 private:
  YamlMap message() { return {document_, "", nullptr, source_}; }

  YamlValue document_;
  YamlSource source_;
  std::map<std::string, double> padding_;  // of links, by name; metres
};

}  // namespace corridor
