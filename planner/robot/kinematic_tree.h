#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "collision/motion/rigid_motion.h"
#include "planner/robot/configuration_space.h"

namespace corridor {

/// A frame of a kinematic tree: where it stands in its parent's, by a fixed pose and one elementary
/// joint after it, X_PF(q) = fixed · joint(q), in real arithmetic on these doubles (quaternions and
/// axes normalised in real arithmetic). Joints of several freedoms are several frames (planar:
/// shift, then turn; floating: shift, then rotate).
struct Frame {
  enum class Joint {
    none,
    turn,    ///< by an angle about `axis`
    slide,   ///< by a length along `axis`
    shift,   ///< by a vector of two (x, y) or three numbers
    rotate,  ///< by a quaternion
  };
  static constexpr std::size_t noVariable = SIZE_MAX;

  std::string name;  ///< of the link, "left/hand"; of inner frames: the joint's
  std::size_t parent = 0;
  RigidPose fixed;  ///< X_P0
  Joint joint = Joint::none;
  Vec3 axis = Vec3::UnitZ();  ///< in the frame after `fixed`; any length but 0
  /// Index of the first number in a Configuration; noVariable: a turn or slide held at `offset`.
  std::size_t variable = noVariable;
  std::size_t count = 1;              ///< numbers of a shift: 2 or 3
  double multiplier = 1, offset = 0;  ///< turn, slide: value = multiplier·q + offset
};

/// All that moves, and the world that it stands in: frame 0 is the world, parents come before their
/// children. Plain data, read by the planner's kinematics and by the verifier's own.
struct KinematicTree {
  std::vector<Frame> frames{Frame{}};

  std::size_t add(Frame frame) {
    frames.push_back(std::move(frame));
    return frames.size() - 1;
  }
};

/// The pose of every frame in the world, rounded.
std::vector<Transform> framePoses(const KinematicTree& tree, const Configuration& q);

}  // namespace corridor
