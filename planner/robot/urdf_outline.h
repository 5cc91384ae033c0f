#pragma once

#include <optional>
#include <string>
#include <vector>

#include "planner/robot/mesh_store.h"
#include "planner/robot/robot_model.h"
#include "planner/robot/xml_file.h"

/// What a URDF says, element by element, before it is known to be a robot. Not for users of the
/// library. Everything that can be wrong in a single element is faulted here; what is wrong between
/// elements is `checkUrdfTree`'s.
namespace corridor {

struct UrdfCollision {
  Vec3 rpy = Vec3::Zero();     ///< of its origin, whose rest is urdfdom's
  std::filesystem::path mesh;  ///< empty: not a mesh
  int line = 0;
};

struct UrdfLink {
  std::string name;
  int line = 0;
  std::vector<UrdfCollision> collisions;
};

struct UrdfMimic {
  std::string joint;
  double multiplier = 1;
  int line = 0;
};

struct UrdfJoint {
  std::string name;
  int line = 0;
  std::optional<JointType> type;  ///< nullopt: faulted
  std::string parent, child;      ///< "": faulted
  Vec3 rpy = Vec3::Zero();        ///< of its origin, whose rest is urdfdom's
  bool ranged = false;            ///< its <limit> has lower or upper, or both
  std::optional<UrdfMimic> mimic;
};

/// In the order of the file; elements without a name are left out.
struct UrdfOutline {
  std::string name;
  std::vector<UrdfLink> links;
  std::vector<UrdfJoint> joints;
  bool complete = true;  ///< no link or joint was left out for want of a name of its own
};

/// @pre file.root(). Meshes are read into `meshes`. Numbers in the XML are rewritten in plain
/// decimals.
UrdfOutline readUrdfOutline(XmlFile& file, MeshStore& meshes, std::vector<std::string>& notes);

/// Faults what isn't a tree of links with one root, and mimics that follow nothing.
/// @returns the joints, by index, in the tree's order: depth first, siblings as in the file. Empty
/// where anything is faulted.
std::vector<std::size_t> checkUrdfTree(const UrdfOutline& outline, XmlFile& file);

}  // namespace corridor
