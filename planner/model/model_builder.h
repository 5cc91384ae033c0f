#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "collision/core/error.h"
#include "planner/model/bounds.h"
#include "planner/robot/urdf_file.h"

namespace corridor {

/// How a robot that is read from a URDF takes part in a model.
struct UrdfOptions {
  /// For several robots: comes before the names of its links, joints and coordinates, as in
  /// "left/hand".
  std::string name = {};
  RigidPose base = {};              ///< X_WB
  std::filesystem::path srdf = {};  ///< allowed pairs of links; empty: none
  PackageMap packages = {};         ///< see readUrdf
  /// The joints that are planned for; empty: all that move by themselves. The others are held at
  /// the value nearest to 0 within their limits.
  std::vector<std::string> joints = {};
};

/// Makes a model from robots and obstacles. Add all robots before the obstacles. Faults are kept
/// until `build`, which throws all of them at once.
class ModelBuilder {
 public:
  /// Adds a robot with joints. Planar and floating joints need bounds (`bound`).
  ModelBuilder& addRobot(const std::filesystem::path& urdf, const UrdfOptions& options = {});
  /// Adds a robot whose members are set, except for those that the builder sets.
  ModelBuilder& addRobot(ModelRobot robot);
  /// Adds a rigid body that moves in the plane (`planar`) or in space (`floating`). Its coordinates
  /// are called "NAME/x", "NAME/y", … Shapes: see `shapeOf`.
  /// @param bounds of its position.
  ModelBuilder& addRigidBody(const std::string& name, JointType type,
                             std::vector<PlacedShape> shapes, const Corners& bounds);
  /// Adds an obstacle, or nothing if there are no shapes.
  ModelBuilder& addObstacle(std::string name, std::vector<PlacedShape> shapes);
  ModelBuilder& addObstacle(const std::string& name, const Primitive& primitive,
                            const RigidPose& at = {});

  /// Bounds the position of a planar or floating joint, or of a rigid body, by its name.
  ModelBuilder& bound(std::string joint, const Corners& bounds);
  /// Excludes a pair of bodies from all tests, by their names.
  ModelBuilder& allow(std::string a, std::string b);

  /// Returns the model. Links are not tested against each other if their robot's SRDF allows it,
  /// if they are adjacent, or if they never move against each other. The builder is then empty.
  /// @throws InputError with all faults: those of the URDF and SRDF files; unknown or repeated
  /// names; missing or bad bounds; more than 10^7 pairs of bodies.
  Model build();
  /// The same for readers, which set bounds and allowed pairs afterwards: positions without bounds
  /// are NaN, and the number of pairs is not limited.
  Model buildUnbounded();

 private:
  void fault(std::string text);
  void applyBounds();
  std::vector<std::array<std::size_t, 2>> allowedBodies();

  struct Bound {
    std::string joint;
    Corners corners;
  };
  Model model_;
  CoordinateGroup joints_;  // all single joints
  std::vector<Bound> bounds_;
  std::vector<std::array<std::string, 2>> allowed_;
  std::vector<Fault> faults_;
};

/// Makes the description of a rigid robot. @param type planar or floating.
RobotModel rigidModel(const std::string& name, JointType type, std::vector<PlacedShape> shapes);

/// Makes a shape. A primitive must be legal (`checkPrimitive`). A mesh is solid if everything
/// inside it belongs to it, else a surface; it must then be watertight.
PlacedShape shapeOf(std::string name, const Primitive& primitive, const RigidPose& at = {});
PlacedShape shapeOf(std::string name, TriangleMesh mesh, bool solid = false);

/// Throws where a model has more pairs of bodies than are handled, 10^7.
/// @param place for the message: the problem's file.
/// @throws InputError
void requireFewPairs(const Model& model, const std::string& place);

}  // namespace corridor
