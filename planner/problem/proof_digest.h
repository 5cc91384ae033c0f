#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "planner/robot/robot_description.h"

/// The digest of a list `never_in_contact`: it ties the list to the robot for which its pairs were
/// proved. If the robot, the list or what the proof covers changes, the digest no longer matches.
namespace corridor {

/// The SHA-256 of a robot's links, shapes and joints.
using RobotDigest = std::array<std::uint8_t, 32>;

/// Returns the digest of all that such proofs use of a robot, as it was read: the names, shapes and
/// order of the links (each vertex of a mesh, with all scales and poses applied), and the joints
/// with their poses, axes, limits and mimics. So it depends on the URDF or on what xacro made of
/// it, on the mesh files wherever they were found, and on the keys `visuals`, `limits` and
/// `collada_up`, as far as they change the robot. It does not depend on the joints that are planned
/// for, or on held values: the proofs are for all values of all joints.
///
/// The bytes: integers as 64 bits and doubles as their 64 bits, little-endian; a text as its length
/// and its bytes.
/// - the number of links; for each its name, the number of shapes, and the SHA-256 of each shape;
/// - the number of joints; for each its name, type (JointType), parent, child, X_PJ (x, y, z of the
///   position; x, y, z, w of the quaternion), axis, lower, upper; then 0, or 1 and the index,
///   multiplier and offset of its mimic.
/// The bytes of a shape: 1 if it is solid, else 0; the number of vertices of its mesh (0 without a
/// mesh), the vertices, the number of triangles, and their indices, as 32 bits each; then the
/// number of parts, and for each the number of points, the points, the radius, and 1 if it has flat
/// ends, else 0.
/// @throws std::runtime_error as sha256 does.
RobotDigest digestOfRobot(const RobotDescription& robot);

/// Returns the digest of a list, as 64 hexadecimal digits: the SHA-256 of the text
/// "corridor-never-in-contact-1", the robot's digest (32 bytes), margin, beyondLimits, the number
/// of pairs, and the names of each pair. The two names of a pair, and then the pairs, are in
/// ascending order; so the order in the list does not matter.
std::string proofDigest(const RobotDigest& robot, const AllowedPair::Proof& proof,
                        std::vector<std::array<std::string, 2>> pairs);

}  // namespace corridor
