#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "collision/core/error.h"
#include "planner/model/bounds.h"
#include "planner/robot/robot_parts.h"
#include "planner/robot/urdf_file.h"

namespace corridor {

/// Options of a robot that is read from a URDF.
struct UrdfOptions {
  /// The robot's name. Required if the model has several robots. It is the prefix of the names of
  /// links, joints and coordinates, as in "left/hand".
  std::string name = {};
  RigidPose base = {};              ///< X_WB
  std::filesystem::path srdf = {};  ///< gives pairs of links that may touch; empty: no SRDF
  UrdfRules rules = {};             ///< how the URDF is read
  /// The joints that are planned for; empty: all joints that can move and mimic no other. All other
  /// joints are held: single joints at the value nearest to 0 within their limits, planar and
  /// floating joints at the identity.
  std::vector<std::string> joints = {};
};

/// Makes a model from robots and obstacles. Add all robots before the obstacles. Faults are kept
/// until `build`, which throws all of them at once.
class ModelBuilder {
 public:
  /// The `file` of faults that are not in a file.
  static constexpr const char* kFaultFile = "ModelBuilder";

  /// Adds a robot with joints. Planar and floating joints need bounds (`bound`).
  ModelBuilder& addRobot(const std::filesystem::path& urdf, const UrdfOptions& options = {});
  /// Adds a robot that the program describes by links and joints. Planar and floating joints need
  /// bounds (`bound`).
  /// @param base X_WB. @param joints as in `UrdfOptions`.
  ModelBuilder& addRobot(RobotParts parts, const RigidPose& base = {},
                         const std::vector<std::string>& joints = {});
  /// Adds a robot. @pre All members of `robot` are set, except those that `ModelRobot` lists under
  /// "Set by ModelBuilder".
  ModelBuilder& addRobot(ModelRobot robot);
  /// Adds a rigid body that moves in the plane (`planar`) or in space (`floating`). Its coordinates
  /// have the names "NAME/x", "NAME/y", … The function `shapeOf` makes shapes.
  /// @param bounds the bounds of the body's position.
  ModelBuilder& addRigidBody(const std::string& name, JointType type,
                             std::vector<PlacedShape> shapes, const Corners& bounds);
  /// Adds an obstacle. The obstacle's shapes (`shapeOf`) are in world coordinates. If `shapes` is
  /// empty, adds nothing. If a link or a rigid body has the name NAME, too, the obstacle's name
  /// becomes "world/NAME".
  /// @param X_WO if given, the obstacle has its own frame at this pose, and the shapes are in the
  /// coordinates of that frame. Obstacles can then share one mesh, and its trees, at different
  /// poses.
  ModelBuilder& addObstacle(std::string name, std::vector<PlacedShape> shapes,
                            const std::optional<RigidPose>& X_WO = std::nullopt);
  ModelBuilder& addObstacle(const std::string& name, const Primitive& primitive,
                            const RigidPose& at = {});
  /// Returns whether an obstacle was added under this name. (A second one is a fault.)
  bool hasObstacle(const std::string& name) const { return obstacles_.contains(name); }

  /// Sets the bounds of the position of a planar or floating joint, or of a rigid body.
  /// @param joint the name of the joint or body.
  ModelBuilder& bound(std::string joint, const Corners& bounds);
  /// Excludes a pair of bodies, given by their names, from all tests.
  ModelBuilder& allow(std::string a, std::string b);

  /// Returns the model. The model's filter excludes pairs of bodies that never move against each
  /// other, and the pairs of `allow`. It also excludes two links of a robot if the robot's
  /// description allows them to touch (SRDF), or if they are adjacent. Afterwards the builder is
  /// empty.
  /// @throws InputError with all faults: faults of the URDF and SRDF files; unknown or repeated
  /// names; faults of described robots (`makeRobot`); illegal primitives; a robot that was added
  /// after an obstacle; missing or bad bounds; more than 10^7 pairs of bodies.
  Model build();
  /// Returns the model for readers, which set bounds and allowed pairs afterwards. This function
  /// ignores the calls of `bound` and `allow`: all bounds of positions are NaN. The number of pairs
  /// is not limited. @throws InputError with the faults that were found before this call.
  Model buildForReader();

 private:
  void fault(std::string text);
  void addDescribed(ModelRobot robot, const std::vector<std::string>& joints,
                    const std::string& place);
  void applyBounds();
  std::vector<std::array<std::size_t, 2>> allowedBodies();

  struct Bound {
    std::string joint;
    Corners corners;
  };
  Model model_;
  CoordinateGroup joints_;  // the coordinates of all single joints
  std::vector<Bound> bounds_;
  std::set<std::string> obstacles_;  // their names, as given
  std::vector<std::array<std::string, 2>> allowed_;
  std::vector<Fault> faults_;
};

/// Makes the description of a rigid robot. @param type planar or floating.
RobotDescription rigidModel(const std::string& name, JointType type,
                            std::vector<PlacedShape> shapes);

/// Make a shape. A primitive must be legal (`checkPrimitive`). If `solid` is true, everything
/// inside the mesh belongs to the shape; the mesh must then be watertight, or else the constructor
/// of `Checker` throws. If it is false, the mesh is a surface. Vertices are in the coordinates of
/// the link; for an obstacle, in those of the world or of the obstacle's own frame.
PlacedShape shapeOf(std::string name, const Primitive& primitive, const RigidPose& at = {});
PlacedShape shapeOf(std::string name, TriangleMesh mesh, bool solid = false);

/// Tells the model's filter which bodies never move relative to each other.
void setMovers(Model& model);

/// Checks that a model has at most 10^7 pairs of bodies.
/// @param place for the message: the problem's file.
/// @throws InputError if the model has more pairs.
void requireFewPairs(const Model& model, const std::string& place);

}  // namespace corridor
