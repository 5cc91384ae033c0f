#include "planner/model/bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/core/shortest.h"

namespace corridor {
namespace {

void include(const ConvexPart& part, const Transform& X, Corners& box) {
  // The points of a part are swept by a sphere. Exception: those of a cylinder are swept by a disc
  // at a right angle to the cylinder's axis.
  Vec3 reach = Vec3::Constant(part.radius);
  if (part.flatEnds) {
    const Vec3 along = (X * part.points.back() - X * part.points.front()).stableNormalized();
    for (int k = 0; k < 3; ++k)
      reach[k] = part.radius * std::sqrt(std::max(0.0, 1 - along[k] * along[k]));
  }
  for (const Vec3& point : part.points) {
    const Vec3 p = X * point;
    box.lower = box.lower.cwiseMin(p - reach);
    box.upper = box.upper.cwiseMax(p + reach);
  }
}

void include(const TriangleMesh& mesh, const Transform& X, Corners& box) {
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t i : triangle) {
      const Vec3 p = X * mesh.vertices[i];
      box.lower = box.lower.cwiseMin(p);
      box.upper = box.upper.cwiseMax(p);
    }
}

}  // namespace

std::size_t dimensionsOf(const CoordinateGroup& group) {
  return group.kind == CoordinateGroup::Kind::planar ? 2 : 3;
}

Corners boundsOf(const ConfigurationSpace& space, const CoordinateGroup& group) {
  Corners corners;
  for (std::size_t k = 0; k < dimensionsOf(group); ++k) {
    const Coordinate& c = space.coordinates()[group.coordinates[k]];
    corners.lower[static_cast<Eigen::Index>(k)] = c.lower;
    corners.upper[static_cast<Eigen::Index>(k)] = c.upper;
  }
  return corners;
}

void setBounds(ConfigurationSpace& space, const CoordinateGroup& group, const Corners& corners) {
  for (std::size_t k = 0; k < dimensionsOf(group); ++k) {
    Coordinate& c = space.coordinates()[group.coordinates[k]];
    c.lower = corners.lower[static_cast<Eigen::Index>(k)];
    c.upper = corners.upper[static_cast<Eigen::Index>(k)];
  }
}

std::string whyBadBounds(const Corners& corners, std::size_t dimensions) {
  for (std::size_t i = 0; i < dimensions; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const double lower = corners.lower[k], upper = corners.upper[k];
    if (lower < upper && std::isfinite(upper - lower)) continue;
    const std::string in = std::string("in ") + "xyz"[i] + ", ";
    if (lower < upper)
      return in + "the range from " + shortest(lower) + " to " + shortest(upper) +
             " is larger than any double";
    return "lower corner first, then the upper one: " + in + shortest(lower) + " is not below " +
           shortest(upper);
  }
  return "";
}

Corners boundsOf(const PlacedShape& shape, const Transform& X) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Corners box{Vec3::Constant(infinity), Vec3::Constant(-infinity)};
  for (const ConvexPart& part : shape.parts) include(part, X, box);
  if (shape.mesh) include(shape.mesh->mesh, X, box);
  return box;
}

std::optional<Corners> boundsOfWorld(const Model& model) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Corners box{Vec3::Constant(infinity), Vec3::Constant(-infinity)};
  const std::vector<Transform> X_WF = staticFramePoses(model);
  for (const ModelBody& body : model.bodies) {
    if (body.robot) continue;
    for (const PlacedShape& shape : body.shapes) {
      const Corners own = boundsOf(shape, X_WF[body.frame]);
      box.lower = box.lower.cwiseMin(own.lower);
      box.upper = box.upper.cwiseMax(own.upper);
    }
  }
  return box.lower.x() <= box.upper.x() ? std::optional(box) : std::nullopt;
}

}  // namespace corridor
