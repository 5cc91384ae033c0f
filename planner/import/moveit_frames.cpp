#include "planner/import/moveit_frames.h"

#include <algorithm>
#include <vector>

#include "collision/core/spelling.h"
#include "planner/import/moveit_poses.h"

namespace corridor {
namespace {

const MapKeys kTransforms{{"header", "child_frame_id", "transform"}, {}};

/// Returns the name of a frame without the "/" that ROS 1 allows before it.
std::string withoutSlash(std::string frame) {
  return frame.erase(0, std::min(frame.size(), frame.find_first_not_of('/')));
}

}  // namespace

Placement SceneFrames::placementOf(const YamlMap& message) const {
  const std::string frame = withoutSlash(frameOf(message));
  if (frame == root) return {base, {rotationMatrix(base.q), base.p}};
  if (frame.empty() || (frame == "world" && !worldIsLink)) return {};
  const YamlMap header(*message.find("header"), message.pathOf("header"), nullptr,
                       message.source());
  header.fault("frame_id",
               frame == "world"
                   ? "a link of the robot that is not its root is named \"world\", and objects in "
                     "its frame are not supported; give the object in the frame of the root, " +
                         quotedWord(root)
                   : "the frame of the robot's root, " + quotedWord(root) +
                         ", or \"world\" is needed, not " + quotedWord(frame));
  return {};
}

void SceneFrames::checkTransforms(const YamlMap& scene) const {
  const std::string path = "fixed_frame_transforms";
  std::vector<std::string> others;
  for (const YamlValue* const item : itemsOf(scene, path)) {
    const YamlMap map(*item, path, &kTransforms, scene.source());
    const std::string child = withoutSlash(map.textOrNone("child_frame_id"));
    const std::string parent = withoutSlash(frameOf(map));
    const bool isKnownParent = parent == root || parent == "world" || parent.empty();
    if ((child != root && child != "world") || (child == "world" && !isKnownParent)) {
      map.ignore({"transform"});
      if (child != parent) others.push_back(child);
      continue;
    }
    const YamlValue* const transform = map.find("transform");
    const auto given = transform
                           ? readTransform(*transform, map.pathOf("transform"), scene.source())
                           : std::nullopt;
    if (!given) continue;
    RigidPose own;  // by the problem; the pose of a frame in itself is the identity
    if (child == root && parent != root) own = base;
    if (child == "world" && parent == root)
      own = {-(rotationMatrix(base.q).transpose() * base.p), base.q.conjugate()};
    if (isSamePose(*given, own)) continue;
    const std::string text = "the pose of " + quotedWord(child) + " is " + written(*given) +
                             " here, and " + written(own) +
                             " by the base of the robot in the problem";
    if (isSamePose(base, {}))
      map.fault("transform", text + "; give it by base in the problem");
    else
      map.source().notes.push_back(
          {map.source().file + ": " + map.pathOf("transform") + ": " + text + ", which is used",
           NoteWeight::coverage});
  }
  if (!others.empty())
    scene.source().notes.push_back({scene.source().file + ": " + path +
                                    ": the poses of these frames have no effect, because "
                                    "objects may only be in the world's frame and in the root's: " +
                                    joinedFirst(others)});
}

}  // namespace corridor
