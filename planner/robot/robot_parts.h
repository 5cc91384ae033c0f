#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "planner/robot/robot_description.h"

namespace corridor {

/// A robot that a program describes by links and joints, in place of a URDF. Metres and radians.
struct RobotParts {
  /// The rule of a joint that mimics another one: its value is multiplier·(value of `joint`) +
  /// offset.
  struct Mimicry {
    std::string joint;
    double multiplier = 1, offset = 0;
  };
  struct Joint {
    std::string name;
    JointType type = JointType::fixed;
    std::string parent, child;  ///< names of links
    RigidPose X_PJ;             ///< as in `JointModel`
    Vec3 axis = Vec3::UnitX();  ///< in the joint's frame, of any length above 0; as in URDF
    /// Inclusive limits, rad or m. Revolute and prismatic joints need both, unless they mimic.
    std::optional<double> lower = {}, upper = {};
    std::optional<double> velocity = {};  ///< the largest speed, rad/s or m/s, above 0
    std::optional<Mimicry> mimic = {};
  };

  std::string name = {};         ///< needed if the model has several robots, as in `ModelRobot`
  std::vector<LinkModel> links;  ///< the shapes of each link are in the link's coordinates
  std::vector<Joint> joints;     ///< in any order
  std::vector<std::array<std::string, 2>> allow = {};  ///< pairs of links that are never tested
};

/// Makes the description that `readUrdf` makes of a URDF with these links and joints. If the
/// numbers are equal, the descriptions of both functions are equal to the last bit. All faults are
/// appended to `faults`. If there is a fault, the result is nullopt. Faults are: names that are
/// missing, unknown or not unique; links that are not a tree with one root; numbers that are not
/// finite; illegal primitives; an axis of length 0; limits that are missing, in the wrong order, or
/// given to a joint that has no limits; mimics that form a cycle, that follow an unknown joint, or
/// that would make a joint jump.
std::optional<RobotDescription> makeRobot(RobotParts parts, std::vector<Fault>& faults);

}  // namespace corridor
