#include "planner/checker/enclosed_bodies.h"

#include <optional>

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
        !contains(boxOf(outer), boxOf(inner)) || interference(a, b, context_))
      return false;
    const MeshWithComponents around{a.shape.binaryTree(), a.shape.components()};
    const Posed<MeshWithComponents> solid(around, a.X_W);
    if (!b.shape.isMesh())
      return findEnclosed(solid, Posed(b.shape.parts().front(), b.X_W), context_).has_value();
    const MeshWithComponents within{b.shape.binaryTree(), b.shape.components()};
    return findEnclosed(solid, Posed<MeshWithComponents>(within, b.X_W), context_).has_value();
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
    const TriangleMesh& mesh = inner.shape.mesh();
    const Vec3& point =
        inner.shape.isMesh() ? mesh.corner(0, 0) : inner.shape.parts().front().points.front();
    const Vec3 p = inner.X_W * point, center = outer.X_W * outer.shape.sphereCenter();
    const double slack = 0x1p-20 * (p.stableNorm() + center.stableNorm());
    return (p - center).lpNorm<Eigen::Infinity>() <= outer.shape.sphereRadius() + slack;
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
