#include "collision/geometry/convex_part.h"

#include <cmath>
#include <sstream>

namespace corridor {
namespace {

bool isLength(double x) {
  return std::isfinite(x) && x > 0;
}

template <class... Lengths>
std::optional<std::string> complaint(const char* what, Lengths... lengths) {
  if ((isLength(lengths) && ...)) return std::nullopt;
  std::ostringstream text;
  text << what << " must be positive and finite, not";
  ((text << ' ' << lengths), ...);
  return text.str();
}

struct Check {
  using Complaint = std::optional<std::string>;
  Complaint operator()(const Box& b) const {
    return complaint("a box's three edge lengths", b.size[0], b.size[1], b.size[2]);
  }
  Complaint operator()(const Sphere& s) const { return complaint("a sphere's radius", s.radius); }
  Complaint operator()(const Capsule& c) const {
    return complaint("a capsule's radius and length", c.radius, c.length);
  }
  Complaint operator()(const Cylinder& c) const {
    return complaint("a cylinder's radius and length", c.radius, c.length);
  }
  Complaint operator()(const Convex& c) const {
    if (c.points.empty()) return "a convex shape needs at least one point";
    for (std::size_t i = 0; i < c.points.size(); ++i)
      if (!c.points[i].allFinite())
        return "point " + std::to_string(i) + " (counted from 0) of a convex shape is not finite";
    return std::nullopt;
  }
};

std::vector<Vec3> ends(double length) {
  return {Vec3(0, 0, -length / 2), Vec3(0, 0, length / 2)};
}

struct Local {
  ConvexPart operator()(const Box& b) const {
    ConvexPart part;
    for (int i = 0; i < 8; ++i)
      part.points.push_back(
          0.5 * b.size.cwiseProduct(Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
    return part;
  }
  ConvexPart operator()(const Sphere& s) const { return {{Vec3::Zero()}, s.radius, false}; }
  ConvexPart operator()(const Capsule& c) const { return {ends(c.length), c.radius, false}; }
  ConvexPart operator()(const Cylinder& c) const { return {ends(c.length), c.radius, true}; }
  ConvexPart operator()(const Convex& c) const { return {c.points, 0, false}; }
};

struct Name {
  std::string operator()(const Box&) const { return "box"; }
  std::string operator()(const Sphere&) const { return "sphere"; }
  std::string operator()(const Capsule&) const { return "capsule"; }
  std::string operator()(const Cylinder&) const { return "cylinder"; }
  std::string operator()(const Convex&) const { return "convex"; }
};

}  // namespace

std::optional<std::string> checkPrimitive(const Primitive& primitive) {
  return std::visit(Check(), primitive);
}

std::string nameOf(const Primitive& primitive) {
  return std::visit(Name(), primitive);
}

ConvexPart placed(const Primitive& primitive, const Transform& X_BodyPrimitive) {
  ConvexPart part = std::visit(Local(), primitive);
  for (Vec3& p : part.points) p = X_BodyPrimitive * p;
  return part;
}

}  // namespace corridor
