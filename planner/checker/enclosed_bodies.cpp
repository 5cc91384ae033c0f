#include "planner/checker/enclosed_bodies.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "collision/core/floating_point.h"
#include "collision/core/spelling.h"
#include "collision/queries/containment.h"
#include "collision/world/body_queries.h"
#include "planner/checker/fixed_pairs.h"
#include "planner/model/bounds.h"

namespace corridor {
namespace {

bool contains(const Corners& outer, const Corners& inner) {
  return (outer.lower.array() <= inner.lower.array()).all() &&
         (inner.upper.array() <= outer.upper.array()).all();
}

/// Returns whether a body is a link of a robot with joints.
bool isLink(const Model& model, std::size_t body) {
  const auto& robot = model.bodies[body].robot;
  return robot && !model.robots[*robot].isRigid();
}

class EnclosureTest {
 public:
  EnclosureTest(const Checker& checker, const Configuration& q)
      : scene_(checker.scene()), X_WF_(framePoses(checker.model().tree, q)) {
    for (const ModelBody& body : checker.model().bodies)
      for (const PlacedShape& shape : body.shapes) shapes_.push_back(&shape);
    boxes_.resize(shapes_.size());
  }

  /// @param outer, inner shapes of the scene.
  bool operator()(std::size_t outer, std::size_t inner) {
    const Posed<Body> a = posed(outer), b = posed(inner);
    if (!a.shape.isMesh() || a.shape.solid() || !isNear(a, b) ||
        !contains(boxOf(outer), boxOf(inner)) || !mayContain(a, b) || interference(a, b, context_))
      return false;
    const MeshWithComponents around{a.shape.binaryTree(), a.shape.components()};
    const Posed<MeshWithComponents> solid(around, a.X_W);
    const auto isInside = [&](const Vec3& point) {
      return containing(solid, point, b.X_W, context_).has_value();
    };
    return b.shape.isMesh()
               ? std::ranges::any_of(b.shape.components().components,
                                     [&](const auto& each) { return isInside(each.corner); })
               : isInside(pointOf(b.shape));
  }

 private:
  Posed<Body> posed(std::size_t shape) const {
    const Scene::Placed& placed = scene_.bodies()[shape];
    return Posed(placed.body, X_WF_[placed.frame]);
  }

  /// Returns whether a point of the inner body is in the cube about the outer body's sphere, up to
  /// 2^-20 of the lengths, which exceeds all rounding. The outer body's box in the world is in this
  /// cube. Boxes are more exact, but take far longer.
  static bool isNear(const Posed<Body>& outer, const Posed<Body>& inner) {
    const Vec3 p = inner.X_W * pointOf(inner.shape),
               center = outer.X_W * outer.shape.sphereCenter();
    const double slack = 0x1p-20 * (p.stableNorm() + center.stableNorm());
    return (p - center).lpNorm<Eigen::Infinity>() <= outer.shape.sphereRadius() + slack;
  }

  static const Vec3& pointOf(const Body& body) {
    return body.isMesh() ? body.mesh().corner(0, 0) : body.parts().front().points.front();
  }

  /// Returns whether a watertight component may contain a corner of the inner body. A mesh is
  /// inside if any of its components is.
  static bool mayContain(const Posed<Body>& outer, const Posed<Body>& inner) {
    const Transform X_AB = rigidInverse(outer.X_W) * inner.X_W;
    // More than the rounding of a point of the inner body in the frame of the outer one, which is
    // some 2^-50 of these lengths.
    const double error = 0x1p-44 * (outer.X_W.t.stableNorm() + inner.X_W.t.stableNorm() +
                                    outer.shape.radius() + inner.shape.radius());
    const auto isOut = [&](const Vec3& point) {
      return isOutside(outer.shape, X_AB * point, error);
    };
    return inner.shape.isMesh()
               ? !std::ranges::all_of(inner.shape.components().components,
                                      [&](const auto& each) { return isOut(each.corner); })
               : !isOut(pointOf(inner.shape));
  }

  /// Returns whether a point is certainly in no watertight component: outside of its box, or a ray
  /// from the point crosses it an even number of times. `containing` is exact, but needs a tree,
  /// which takes a hundred times as long for a scene's mesh.
  ///
  /// Let v be a triangle's corners as seen from p. A triple product is off by some 2^-50 of the
  /// lengths of its factors, and by `error` times the products of two (or, with the ray, of one) of
  /// the lengths. If one is not larger, nothing is certain.
  /// @param error of p, metres
  static bool isOutside(const Body& body, const Vec3& p, double error) {
    constexpr double kRounding = 0x1p-44;
    const MeshComponents& all = body.components();
    std::vector<std::size_t> crossings(all.components.size(), 0);
    std::vector<char> isAround;
    for (const MeshComponents::Component& each : all.components)
      isAround.push_back(each.watertight &&
                         (each.lower - p).cwiseMax(p - each.upper).maxCoeff() <= error);
    if (std::ranges::find(isAround, 1) == isAround.end()) return true;
    const Vec3 ray(0.318, 0.427, 0.846);  // about a unit vector
    for (std::size_t t = 0; t < all.of.size(); ++t) {
      if (!isAround[all.of[t]]) continue;
      Vec3 v[3];
      double length[3];
      for (int i = 0; i < 3; ++i) length[i] = (v[i] = body.mesh().corner(t, i) - p).norm();
      int left = 0, right = 0;
      double pairs = 0;  // sum of the products of two lengths
      for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        const double side = ray.dot(v[i].cross(v[j])), both = length[i] * length[j];
        const double unsure = kRounding * both + 2 * error * (length[i] + length[j]);
        left += side > unsure;
        right += side < -unsure;
        pairs += both;
      }
      if (left > 0 && right > 0) continue;  // the ray's line passes the triangle
      const double volume = v[0].dot(v[1].cross(v[2]));
      if ((left < 3 && right < 3) ||
          !(std::abs(volume) > kRounding * length[0] * length[1] * length[2] + 2 * error * pairs))
        return false;  // unsure
      crossings[all.of[t]] += (volume > 0) == (left == 3);
    }
    return std::ranges::none_of(crossings, [](std::size_t n) { return n % 2 == 1; });
  }

  const Corners& boxOf(std::size_t shape) {
    std::optional<Corners>& box = boxes_[shape];
    if (!box) box = boundsOf(*shapes_[shape], X_WF_[scene_.bodies()[shape].frame]);
    return *box;
  }

  const Scene& scene_;
  std::vector<Transform> X_WF_;
  std::vector<const PlacedShape*> shapes_;     // in the order of the scene's bodies
  std::vector<std::optional<Corners>> boxes_;  // in the world, once they were needed
  QueryContext context_;
};

}  // namespace

std::vector<EnclosedBody> enclosedBodies(const Checker& checker, const Configuration& q) {
  requireStandardFloatingPoint();
  EnclosureTest test(checker, q);
  std::vector<EnclosedBody> found;
  for (const Scene::Pair& pair : checker.scene().pairs())
    for (const auto& [outer, inner] : {std::pair(pair.a, pair.b), std::pair(pair.b, pair.a)})
      if (test(outer, inner)) found.push_back({checker.bodyOf(outer), checker.bodyOf(inner)});
  return found;
}

std::vector<Note> notesOnStart(const Checker& checker, const Configuration& q) {
  std::vector<Note> notes = notesOnFixedPairs(checker, q);
  const std::vector<ModelBody>& bodies = checker.model().bodies;
  std::vector<std::string> names;
  std::string key;
  for (const EnclosedBody& pair : enclosedBodies(checker, q)) {
    const std::string name = bodies[pair.inner].name + " in " + bodies[pair.outer].name;
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
    if (key.empty())
      key = isLink(checker.model(), pair.outer)
                ? "solid: true in robot.yaml, for all links or some,"
                : "solid: true beside the mesh";
  }
  if (!names.empty())
    notes.push_back(
        {"bodies are inside closed meshes, without touching them: " + joinedFirst(names, 6) +
             "; a mesh is a surface, so this is no contact (" + key + " makes the inside solid)",
         NoteWeight::coverage});
  return notes;
}

}  // namespace corridor
