#pragma once

#include <array>
#include <optional>

#include "collision/core/transform.h"
#include "collision/geometry/triangle_mesh.h"
#include "collision/motion/rigid_motion.h"

namespace corridor::verify {

/// Three corners, in metres. Any three points: repeated and collinear ones are the segment or point
/// that they span.
using Corners = std::array<Vec3, 3>;

/// Do the closed triangles `fixed` and the image of `moving` under `pose` share a point? Exact for
/// the doubles given: the quaternion is normalised in rational arithmetic, R(q)·|q|² being a
/// polynomial of its four numbers.
/// @return a common point, rounded; nullopt if there is none.
std::optional<Vec3> exactContact(const RigidPose& pose, const Corners& moving,
                                 const Corners& fixed);

}  // namespace corridor::verify
