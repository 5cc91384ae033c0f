#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "planner/problem/problem.h"

namespace corridor::view {

/// What a graphics card is given of a problem: surfaces in float, and which of them is on which
/// frame. Lengths in metres.

/// Positions are those of `origin` and of floats from it, so that they are as fine far from the
/// frame's own origin as near it: vertex k is off by at most 2^-24 of its distance from `origin`.
struct DisplayMesh {
  Vec3 origin = Vec3::Zero();          ///< the middle of its bounds
  std::vector<float> positions;        ///< x, y, z of each vertex
  std::vector<std::uint32_t> indices;  ///< three a triangle
  bool operator==(const DisplayMesh&) const = default;
};

struct DisplayBody {
  std::string name;
  std::size_t frame = 0;             ///< 0: an obstacle
  std::optional<std::size_t> robot;  ///< none: an obstacle
  std::size_t mesh = 0;              ///< equal meshes are one
};

struct DisplayScene {
  std::vector<DisplayMesh> meshes;
  std::vector<DisplayBody> bodies;  ///< in the problem's order
  /// Positions of poses and points are told from here, a point amid the bodies: the world's
  /// coordinates may be large.
  Vec3 origin = Vec3::Zero();
  /// Frames that bodies are on, but the world's.
  std::vector<std::size_t> frames;
  /// Of each robot the last frame that bears a body: a rigid body's own, an arm's hand. Robots
  /// without one are left out.
  std::vector<std::size_t> lastFrames;
  /// All that moves turns about vertical axes and goes level: it is seen best from above.
  bool planar = false;
};

/// All shapes of a body are one mesh, curved ones tessellated.
DisplayScene displayScene(const Problem& problem);

/// Poses of `scene.frames` as floats: x, y, z from the scene's origin, and the quaternion x, y, z,
/// w: seven a frame.
std::vector<float> displayPoses(const DisplayScene& scene, const std::vector<Transform>& X_WF);

}  // namespace corridor::view
