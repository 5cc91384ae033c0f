#pragma once

#include <string>

#include "planner/problem/placement.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {

/// The frames that a MoveIt scene may name: the world, and the robot's root link.
struct SceneFrames {
  std::string root;  ///< the name of the root link
  RigidPose base;    ///< of the root link in the world
  bool worldIsLink;  ///< whether another link than the root is named "world"

  /// Returns the pose in the world of the frame that the `header` of a message names. Another frame
  /// is a fault.
  Placement placementOf(const YamlMap& message) const;

  /// Compares the poses in `fixed_frame_transforms` of the root link and of the world, relative to
  /// each other, with the base. A difference is a fault; a note, if the problem gives a base. The
  /// poses of other frames have no effect, because objects in them are faults; a note says so.
  void checkTransforms(const YamlMap& scene) const;
};

}  // namespace corridor
