#pragma once

#include <optional>
#include <string>

#include "collision/core/rigid_pose.h"
#include "planner/problem/yaml_reader.h"
#include "planner/robot/note.h"

/// Readers of poses in problem and robot files.
namespace corridor {

/// A rotation in two forms: the quaternion as given (its norm need not be 1), and the matrix that
/// is applied to a mesh's vertices.
struct Orientation {
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  Mat3 R = Mat3::Identity();
};

/// Returns the rotation of roll, pitch and yaw (planner/robot/rpy.h).
Orientation fromRpyDegrees(const Vec3& degrees);
Orientation fromRpy(const Vec3& radians);

/// Returns the quaternion, normalised if its norm is not between 0.5 and 2. (Otherwise the squares
/// of very large or very small components would overflow or underflow.) @pre `q` is not zero.
Eigen::Quaterniond ofOrdinarySize(const Eigen::Quaterniond& q);

/// Returns the angle minus whole turns, a double in [−π, π] (collision/core/circle.h).
double wrappedYaw(double radians);
/// Returns the angle brought into (-180, 180] degrees, without rounding.
double wrappedYawDegrees(double degrees);

/// Reads the orientation that a map gives by at most one of rpy_deg, rpy and quat_xyzw. A map
/// without these keys gives the identity. Returns nullopt if a fault was added.
std::optional<Orientation> readOrientation(const YamlMap& map);

/// The pose of a frame or a shape in two forms: as written in the file, and as the map that is
/// applied to points.
struct Placement {
  RigidPose pose;
  Transform X;

  bool isIdentity() const { return X == Transform{}; }
};
/// Returns the composition a · b, rounded.
Placement operator*(const Placement& a, const Placement& b);

/// Reads a pose from a map: `at` and a rotation, both optional. Returns nullopt if a fault was
/// added.
std::optional<Placement> readPlacement(const YamlMap& map);

/// The pose of a rigid robot, or of a planar or floating joint.
struct PlanarOrSpatialPose {
  RigidPose pose;  ///< planar: z is 0, and the rotation is about z, by `yaw`
  double yaw = 0;  ///< planar only, radians in [−π, π]
};
/// The form in which a pose is expected.
struct PoseForm {
  bool spatial = true;            ///< false: planar
  std::string mover;              ///< for messages: "the robot moves in SE3 (rigid: SE3)"
  const MapKeys* keys = nullptr;  ///< the legal keys
};
/// Reads a pose. Returns nullopt if a fault was added. If the pose is planar but `form` is spatial,
/// or the other way round, only one fault is added, such as "goal of the wrong kind: …".
/// @param path the path of the value in its file: "start", "goal[0].left".
/// @param notes gets a note if whole turns were subtracted from a yaw.
std::optional<PlanarOrSpatialPose> readPose(const YamlValue& value, const std::string& path,
                                            const PoseForm& form, YamlSource& source,
                                            std::vector<Note>& notes);

}  // namespace corridor
