#pragma once

#include <optional>
#include <string>

#include "collision/motion/rigid_motion.h"
#include "planner/problem/yaml_reader.h"

/// Poses as problem and robot files write them.
namespace corridor {

/// A rotation in both forms that are needed: as given, and as the map that turns a mesh's vertices.
struct Orientation {
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  Mat3 R = Mat3::Identity();
};

/// Rotation about the fixed axes x (roll), then y (pitch), then z (yaw), as in URDF. Multiples of
/// 90 degrees are exact in R.
Orientation fromRpyDegrees(const Vec3& degrees);
Orientation fromRpy(const Vec3& radians);

/// `yaw` brought into (-π, π] (the doubles of that interval).
double wrappedYaw(double radians);
double wrappedYawDegrees(double degrees);

/// The orientation that a map gives by at most one of rpy_deg, rpy, quat_xyzw; none: no rotation.
/// nullopt: faulted.
std::optional<Orientation> readOrientation(const YamlMap& map);

/// Where a frame or a shape is put, in both forms.
struct Placement {
  RigidPose pose;
  Transform X;

  bool isIdentity() const { return X == Transform{}; }
};
/// Rounded.
Placement operator*(const Placement& a, const Placement& b);

/// Of a map's `at` and rotation, both optional. nullopt: faulted.
std::optional<Placement> readPlacement(const YamlMap& map);

/// A pose of what moves as a whole.
struct PlanarOrSpatialPose {
  RigidPose pose;  ///< planar: z = 0 and the rotation by `yaw`
  double yaw = 0;  ///< planar, in (-π, π]
};
/// How a pose is to be read.
struct PoseForm {
  bool spatial = true;  ///< else planar
  std::string mover;    ///< for messages: "the robot moves in SE3 (rigid: SE3)"
  const MapKeys* keys = nullptr;
};
/// @param path of the value: "start", "goal[0].left".
/// @param notes gets a line where a yaw is wrapped.
/// nullopt: faulted ("goal of the wrong kind: …" where it is a pose of another kind).
std::optional<PlanarOrSpatialPose> readPose(const YamlValue& value, const std::string& path,
                                            const PoseForm& form, YamlSource& source,
                                            std::vector<std::string>& notes);

}  // namespace corridor
