#pragma once

#include <optional>
#include <string>
#include <vector>

#include "planner/robot/mesh_store.h"
#include "planner/robot/robot_model.h"
#include "planner/robot/xml_file.h"

/// The elements of a URDF that are checked and read before urdfdom parses it. Internal: users of
/// the library don't need this header. `readUrdfOutline` reports what is wrong within a single
/// element; `checkUrdfTree` reports what is wrong between elements.
namespace corridor {

struct UrdfCollision {
  Vec3 rpy = Vec3::Zero();     ///< rotation of its origin; urdfdom reads the position
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
  std::optional<JointType> type;  ///< nullopt: a fault was reported
  std::string parent, child;      ///< empty: a fault was reported
  Vec3 rpy = Vec3::Zero();        ///< rotation of its origin; urdfdom reads the position
  bool ranged = false;            ///< its <limit> has lower or upper, or both
  std::optional<UrdfMimic> mimic;
};

/// The links and joints in the order of the file. Those without a unique name are left out.
struct UrdfOutline {
  std::string name;
  std::vector<UrdfLink> links;
  std::vector<UrdfJoint> joints;
  bool complete = true;  ///< no link or joint was left out because it has no unique name
};

/// Reads the elements and the mesh files that they name. Numbers in the XML are rewritten in plain
/// decimals, for urdfdom. @pre file.root() is not null.
UrdfOutline readUrdfOutline(XmlFile& file, MeshStore& meshes, std::vector<std::string>& notes);

/// Reports links that don't form a tree with one root, and mimics that are not supported (of a
/// fixed, planar or floating joint, in a circle, or with a multiplier that would make the joint
/// jump).
/// @returns indices of the joints in the tree's order: depth first, siblings as in the file. Empty
/// if the file has any fault.
std::vector<std::size_t> checkUrdfTree(const UrdfOutline& outline, XmlFile& file);

}  // namespace corridor
