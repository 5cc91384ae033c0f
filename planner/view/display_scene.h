#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "planner/problem/problem.h"

namespace corridor::view {

/// The surfaces of a problem as floats, for a graphics card, and the frames to which the surfaces
/// are fixed. Lengths are in metres.

/// A mesh as floats. Positions are relative to `origin`, so that a mesh far from the origin of its
/// frame is as precise as one near it. Rounding to float changes each relative coordinate by at
/// most 2^-24 of itself.
struct DisplayMesh {
  Vec3 origin = Vec3::Zero();    ///< the centre of the bounding box, in the frame's coordinates
  std::vector<float> positions;  ///< x, y, z of each vertex
  std::vector<std::uint32_t> indices;  ///< three per triangle
  bool operator==(const DisplayMesh&) const = default;
};

struct DisplayBody {
  std::string name;
  std::size_t frame = 0;             ///< the frame that the body is fixed to; 0: the world
  std::optional<std::size_t> robot;  ///< index of its robot; unset: an obstacle
  std::optional<Transform> X_WB;     ///< the pose of an obstacle's mesh, if it is not the identity
  std::size_t mesh = 0;  ///< index into `meshes`; bodies with equal meshes share one mesh
};

struct DisplayScene {
  std::vector<DisplayMesh> meshes;
  std::vector<DisplayBody> bodies;  ///< in the problem's order
  /// The point of the world that positions in the page are relative to, in world coordinates. It is
  /// in the middle of the bodies, so that relative positions are small enough for floats.
  Vec3 origin = Vec3::Zero();
  /// The frames to which bodies of robots are fixed, in ascending order.
  std::vector<std::size_t> frames;
  std::vector<std::size_t> tips;  ///< see `tipFrames`
  /// True if at least one joint moves, and every joint that moves rotates about a vertical axis or
  /// translates horizontally. Such a scene is best seen from above.
  bool planar = false;
};

/// Returns the scene of a problem. All shapes of a body become one mesh; curved shapes are
/// tessellated.
DisplayScene displayScene(const Problem& problem);

/// Returns the poses of `scene.frames` as floats, seven for each frame: x, y, z relative to
/// `scene.origin`, then the quaternion x, y, z, w.
std::vector<float> displayPoses(const DisplayScene& scene, const std::vector<Transform>& X_WF);
/// Returns a pose as the seven floats that `displayPoses` describes.
std::array<float, 7> displayPose(const DisplayScene& scene, const Transform& X_WF);

}  // namespace corridor::view
