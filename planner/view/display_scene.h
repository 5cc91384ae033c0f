#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "planner/problem/problem.h"

namespace corridor::view {

/// The surfaces of a problem in floats, as a graphics card needs them, and the frames to which they
/// are fixed. Lengths are in metres.

/// A mesh in floats. Positions are relative to `origin`, so that meshes far from the frame's origin
/// are as precise as meshes near it: each coordinate is off by at most 2^-24 of itself.
struct DisplayMesh {
  Vec3 origin = Vec3::Zero();          ///< the centre of its bounds, in the frame
  std::vector<float> positions;        ///< x, y, z of each vertex
  std::vector<std::uint32_t> indices;  ///< three per triangle
  bool operator==(const DisplayMesh&) const = default;
};

struct DisplayBody {
  std::string name;
  std::size_t frame = 0;             ///< 0: an obstacle
  std::optional<std::size_t> robot;  ///< unset: an obstacle
  std::optional<Transform> X_WB;     ///< the pose of an obstacle's mesh, if it is not the identity
  std::size_t mesh = 0;              ///< index; bodies with equal meshes share one
};

struct DisplayScene {
  std::vector<DisplayMesh> meshes;
  std::vector<DisplayBody> bodies;  ///< in the problem's order
  /// The world point that poses and points are relative to. It is in the middle of the bodies,
  /// since the world's coordinates may be large.
  Vec3 origin = Vec3::Zero();
  /// Frames with bodies of robots, in ascending order.
  std::vector<std::size_t> frames;
  std::vector<std::size_t> tips;  ///< see tipFrames
  /// True if all joints rotate about vertical axes or translate horizontally: then the scene is
  /// best seen from above.
  bool planar = false;
};

/// Returns a problem's scene. All shapes of a body become one mesh; curved shapes are tessellated.
DisplayScene displayScene(const Problem& problem);

/// Returns the poses of `scene.frames` as floats, seven per frame: x, y, z from the scene's origin,
/// then the quaternion x, y, z, w.
std::vector<float> displayPoses(const DisplayScene& scene, const std::vector<Transform>& X_WF);
/// Returns one such pose.
std::array<float, 7> displayPose(const DisplayScene& scene, const Transform& X_WF);

}  // namespace corridor::view
