#pragma once

#include <optional>
#include <string>
#include <vector>

#include "planner/robot/mesh_store.h"
#include "planner/robot/robot_description.h"
#include "planner/robot/xml_file.h"

/// The elements of a URDF that are checked and read before urdfdom parses it. Internal: users of
/// the library don't need this header. `readUrdfOutline` reports faults within a single element;
/// `checkUrdfTree` reports faults between elements.
namespace corridor {

struct UrdfCollision {
  Vec3 rpy = Vec3::Zero();     ///< rotation of its origin; urdfdom reads the position
  std::filesystem::path mesh;  ///< empty: the shape is not a mesh
  bool isCapsule = false;      ///< urdfdom, which does not know capsules, reads it as a cylinder
  int line = 0;
};

struct UrdfLink {
  std::string name;
  int line = 0;
  std::vector<UrdfCollision> collisions;
};

struct UrdfLimit {
  std::optional<double> lower, upper;  ///< NaN: a fault was reported
  std::optional<double> velocity;      ///< rad/s or m/s; NaN: a fault was reported
  int line = 0;
};

struct UrdfMimic {
  std::string joint;
  double multiplier = 1, offset = 0;
  int line = 0;
};

struct UrdfJoint {
  std::string name;
  int line = 0;
  std::optional<JointType> type;   ///< nullopt: a fault was reported
  std::string parent, child;       ///< empty: a fault was reported
  Vec3 rpy = Vec3::Zero();         ///< rotation of its origin; urdfdom reads the position
  std::optional<UrdfLimit> limit;  ///< narrowed by the soft limits, if the rules say so
  std::optional<UrdfMimic> mimic;
};

/// The links and joints in the order of the file. A link or joint is left out if it has no name, or
/// the name of an earlier link or joint, respectively.
struct UrdfOutline {
  std::string name;
  std::vector<UrdfLink> links;
  std::vector<UrdfJoint> joints;
  bool complete = true;  ///< false: a link or joint was left out
};

/// Reads the elements, and the mesh files that they name. Also changes the XML for urdfdom: numbers
/// are rewritten in plain decimals, and capsules become cylinders. If visuals collide, the <visual>
/// of a link without <collision> becomes a <collision>. @pre file.root() is not null.
UrdfOutline readUrdfOutline(XmlFile& file, const UrdfRules& rules, MeshStore& meshes,
                            std::vector<Note>& notes);

/// Reports a fault if the links don't form a tree with one root.
/// @returns indices of the joints in the tree's order: depth first, siblings as in the file. Empty
/// if the robot has any fault.
std::vector<std::size_t> checkUrdfTree(const UrdfOutline& outline, RobotFaults& faults);

/// Resolves chains of mimics, and checks the limits of the joints that mimic no other joint. Only
/// the limits of the leader count, as in other programs that read URDF; a note is added if a
/// follower's own limits disagree. If the leader is not in the robot, or is not a joint of one
/// variable, the follower is used as a joint of its own, with a note. Mimics that form a cycle, and
/// mimics that would make a joint jump, are faults.
/// @returns the rule of each joint, in the outline's order, or nullopt for a joint that follows no
/// other. `Mimic::joint` is an index in the outline.
std::vector<std::optional<Mimic>> resolveMimics(const UrdfOutline& outline, RobotFaults& faults,
                                                std::vector<Note>& notes);

/// Completes a description that already has links, and joints in the order of `checkUrdfTree`: sets
/// the rules of mimics and the root, and allows adjacent links to touch.
/// @param order, mimics as `checkUrdfTree` and `resolveMimics` return them.
void finishRobot(const std::vector<std::size_t>& order,
                 const std::vector<std::optional<Mimic>>& mimics, RobotDescription& model);

/// Returns the axis scaled by a power of two, so that its largest component is in [1, 2). Then the
/// squares of the components do not overflow, and the sum of the squares does not underflow. The
/// scaling is exact.
/// @pre `axis` is finite and not 0.
Vec3 scaledAxis(const Vec3& axis);

}  // namespace corridor
