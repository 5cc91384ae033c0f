#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "collision/core/transform.h"

namespace corridor {

/// Primitives as users write them. Each is solid and centred at the origin of its own frame;
/// metres.
struct Box {
  Vec3 size;  ///< full edge lengths
};
struct Sphere {
  double radius;
};
struct Capsule {
  double radius, length;  ///< along z; `length`: between the centres of the end spheres
};
struct Cylinder {
  double radius, length;  ///< along z; full length
};
struct Convex {
  std::vector<Vec3> points;  ///< the solid is their convex hull, which may be flat
};
using Primitive = std::variant<Box, Sphere, Capsule, Cylinder, Convex>;

/// Returns what is wrong with a primitive (not finite, not positive, no points), or nullopt if the
/// primitive is valid.
std::optional<std::string> checkPrimitive(const Primitive& primitive);

/// Returns "box", "sphere", …
std::string nameOf(const Primitive& primitive);

/// A convex part: a convex solid in the frame of its body. Queries treat the stored doubles as
/// exact; curved surfaces are not tessellated.
/// * Without `flatEnds`: the hull of `points` swept by a sphere of `radius`. A sphere has one
///   point, and a capsule has two. A box has eight points and radius 0. A `Convex` has the points
///   that the user gave, and radius 0.
/// * With `flatEnds`: a cylinder. It is the segment between two points, swept by a disc of `radius`
///   that is orthogonal to the segment.
struct ConvexPart {
  std::vector<Vec3> points;
  double radius = 0;
  bool flatEnds = false;
};

/// Returns the primitive in the frame of a body. This function applies the pose once. Queries use
/// the rounded coordinates that result. Points are mapped; radii stay the same, even under a pose
/// that is not rigid.
/// @pre `checkPrimitive` reports nothing; `placed` does not call it.
ConvexPart placed(const Primitive& primitive, const Transform& X_BodyPrimitive);

}  // namespace corridor
