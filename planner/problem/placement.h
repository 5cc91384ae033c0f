#pragma once

#include <optional>
#include <string>

#include "collision/motion/rigid_motion.h"
#include "planner/problem/problem.h"
#include "planner/problem/yaml_reader.h"

/// Poses and placed meshes, as problem and robot files write them.
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

/// A `start` or `goal`.
struct PlanarOrSpatialPose {
  RigidPose pose;  ///< SE2: z = 0 and the rotation by `yaw`
  double yaw = 0;  ///< SE2, in (-π, π]
};
/// @param value of the key `what` ("start", "goal"), a pose of a robot that moves in `space`.
/// @param notes gets a line where a yaw is wrapped.
/// nullopt: faulted ("goal of the wrong kind: …" where it is a pose of another kind of robot).
std::optional<PlanarOrSpatialPose> readPose(const YamlValue& value, const std::string& what,
                                            RigidSpace space, YamlSource& source,
                                            std::vector<std::string>& notes);

/// A mesh with its unit, up-axis and local pose, all applied to the vertices: v ↦ R·turn(scale·v) +
/// at.
/// @param folder that relative names start from. nullopt: faulted.
std::optional<ProblemMesh> readPlacedMesh(const YamlMap& map, const std::string& name,
                                          const std::filesystem::path& folder);

}  // namespace corridor
