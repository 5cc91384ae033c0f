#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "planner/import/moveit_state.h"
#include "planner/model/model_builder.h"
#include "planner/model/task.h"
#include "planner/problem/problem.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {

/// A message moveit_msgs/PlanningScene, written as YAML. The members read parts of the message, and
/// add faults to the problem's list.
///
/// The members read the collision objects (primitives and meshes), the octomap, the allowed
/// collision matrix and the paddings of links. Some content is a fault, because the resulting path
/// would be wrong if this content were ignored: a scene that is a difference to another one
/// (`is_diff`), attached objects, planes, scaled links, objects in a frame other than the world's
/// or that of the robot's root link, and unknown keys. Fields without any effect are ignored:
/// names, stamps, colours, subframes. All other fields with another value than messages have by
/// default are in a note.
class MoveitScene {
 public:
  /// @throws InputError if the file is not YAML.
  MoveitScene(const std::filesystem::path& file, FaultList& faults);

  /// Holds joints that are not planned for at their values in the scene's `robot_state` (`holdAt`).
  void hold(RobotSetup& setup);
  /// Adds each collision object, and the octomap, as an obstacle. Objects in the frame of the
  /// robot's root link are placed relative to the robot's base.
  /// @param root the name of the robot's root link.
  void addWorld(const std::string& root, const RigidPose& base, ModelBuilder& builder);
  /// Applies the allowed collision matrix (`applyAllowedMatrix`).
  void applyAllowed(Model& model);
  /// Returns the paddings of links (metres). As in MoveIt, they apply to pairs of a link and an
  /// obstacle.
  /// @pre `addWorld` was called.
  Padding paddingOf(const Model& model) const;
  /// Returns the notes on the scene: another robot, other values of planned joints than the start,
  /// paddings or a matrix with names of links or bodies that the model does not have, and values
  /// that are not used. @pre All other members that read the scene were called.
  std::vector<Note> takeNotes(const Problem& problem);

 private:
  void noteNames(const Model& model, std::vector<Note>& notes);
  YamlMap message() { return {document_, "", nullptr, source_}; }

  YamlValue document_;
  YamlSource source_;
  std::optional<MoveitState> state_;
  std::map<std::string, double> padding_;  // of links, by name; metres
  bool worldIsLink_ = false;               // a link that is not the root is named "world"
};

}  // namespace corridor
