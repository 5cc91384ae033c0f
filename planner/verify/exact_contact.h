#pragma once

#include <array>
#include <optional>

#include "collision/core/rigid_pose.h"
#include "collision/core/transform.h"
#include "collision/geometry/triangle_mesh.h"

namespace corridor::verify {

/// The corners of a triangle, metres. Repeated or collinear corners are allowed; they span a point
/// or a segment.
using Corners = std::array<Vec3, 3>;

/// Decides whether the closed triangle `fixed` and the image of the closed triangle `moving` under
/// `pose` share a point. The decision is exact for the given doubles. It is computed in rational
/// arithmetic, without roots: R(q)·|q|² is a polynomial of the four numbers of the quaternion q.
/// @returns a common point, rounded, or nullopt if the triangles have no common point.
std::optional<Vec3> exactContact(const RigidPose& pose, const Corners& moving,
                                 const Corners& fixed);

}  // namespace corridor::verify
