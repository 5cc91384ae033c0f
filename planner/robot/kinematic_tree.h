#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "collision/core/rigid_pose.h"
#include "planner/robot/configuration_space.h"

namespace corridor {

/// A frame of a kinematic tree. Its pose in the parent's frame is a fixed pose followed by one
/// elementary joint: X_PF(q) = fixed · joint(q). The definition holds in real arithmetic on the
/// stored doubles. Quaternions and axes are normalised in real arithmetic, too.
///
/// A joint with several degrees of freedom is a chain of frames. Planar: `translation`, then
/// `revolute`. Floating: `translation`, then `rotation`.
struct Frame {
  enum class Joint {
    none,
    revolute,     ///< rotation by an angle about `axis`
    prismatic,    ///< translation by a length along `axis`
    translation,  ///< translation by a vector of two (x, y) or three numbers
    rotation,     ///< free rotation, by a quaternion
  };
  static constexpr std::size_t noVariable = SIZE_MAX;

  /// The name of the link, such as "left/hand", or of the obstacle. A planar or floating joint, or
  /// a rigid robot, has two frames. The first of them has the joint's name, or the name "position"
  /// for a rigid robot; the second has the name of the link or robot.
  std::string name;
  std::size_t parent = 0;
  RigidPose fixed;  ///< X_P0: pose in the parent's frame
  Joint joint = Joint::none;
  Vec3 axis = Vec3::UnitZ();  ///< in the coordinates after `fixed`; of any length above 0
  /// Index of the joint's first number in a Configuration. If the index is `noVariable`, a
  /// `revolute` or `prismatic` joint is held at `offset`.
  std::size_t variable = noVariable;
  std::size_t count = 1;              ///< `translation` only: the number of its components, 2 or 3
  double multiplier = 1, offset = 0;  ///< `revolute`, `prismatic`: value = multiplier·q + offset

  bool moves() const { return joint != Joint::none && variable != noVariable; }
};

/// The frames of all robots, of the world, and of the obstacles that have a frame of their own.
/// Frame 0 is the world; parents come before their children. The tree is plain data. Both the
/// planner's kinematics and the verifier's independent kinematics read it.
struct KinematicTree {
  std::vector<Frame> frames{Frame{}};

  std::size_t add(Frame frame) {
    frames.push_back(std::move(frame));
    return frames.size() - 1;
  }
  /// Returns the lowest common ancestor of a and b. A frame counts as an ancestor of itself.
  std::size_t commonAncestor(std::size_t a, std::size_t b) const {
    while (a != b) {  // the later frame is not above the other one
      std::size_t& later = a > b ? a : b;
      later = frames[later].parent;
    }
    return a;
  }
};

/// Returns the pose of every frame in the world, computed in double. Each angle is off by up to
/// 2^-51·(|multiplier·q| + |offset|), which matters if a mimic multiplies a large value. Certified
/// queries don't use these poses. They use the poses of edge_motion.h, whose errors are bounded.
std::vector<Transform> framePoses(const KinematicTree& tree, const Configuration& q);
/// Computes the poses of some frames only, and stores them in X_WF.
/// @param frames in ascending order. For each frame, the parent must be in the list, or X_WF must
/// already contain the parent's pose.
void setFramePoses(const KinematicTree& tree, const Configuration& q,
                   std::span<const std::size_t> frames, std::vector<Transform>& X_WF);

}  // namespace corridor
