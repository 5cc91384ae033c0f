#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "collision/core/transform.h"

namespace corridor {

/// Primitives as users write them, metres; each is solid, centred at the origin of its own frame.
struct Box {
  Vec3 size;  ///< full edge lengths
};
struct Sphere {
  double radius;
};
struct Capsule {
  double radius, length;  ///< along z; length between the centres of the two balls
};
struct Cylinder {
  double radius, length;  ///< along z; full length
};
struct Convex {
  std::vector<Vec3> points;  ///< the solid is their convex hull; any set, flat ones too
};
using Primitive = std::variant<Box, Sphere, Capsule, Cylinder, Convex>;

/// What is wrong with a primitive (not finite, not positive, no points), or nothing.
std::optional<std::string> checkPrimitive(const Primitive& primitive);

/// "box", "sphere", …
std::string nameOf(const Primitive& primitive);

/// A convex solid in the frame of its body: what is stored is the model, in real arithmetic on
/// these doubles. The hull of `points` swept by a ball of `radius` (a sphere has one point, a
/// capsule two, a box eight and radius 0); or, with `flatEnds`, a cylinder: the segment between the
/// two points swept by a disc of `radius` at a right angle to it. Curved surfaces are not
/// tessellated.
struct ConvexPart {
  std::vector<Vec3> points;
  double radius = 0;
  bool flatEnds = false;
};

/// The primitive in the frame of a body, local pose applied once (rounded: the result is the
/// model). Points are mapped, radii stay: a pose that isn't rigid makes no other curved shape of
/// it. Whoever isn't sure of the primitive asks `checkPrimitive` first: nobody does here.
ConvexPart placed(const Primitive& primitive, const Transform& X_BodyPrimitive);

}  // namespace corridor
