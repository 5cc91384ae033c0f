#include "collision/world/body_queries.h"

#include <cmath>
#include <stdexcept>

#include "collision/hierarchy/with_trees.h"
#include "collision/queries/containment.h"
#include "collision/queries/interference.h"
#include "collision/queries/interference_obb4.h"
#include "collision/queries/surface_distance.h"

namespace corridor {
namespace {

void require(const Posed<Body>& a, const Posed<Body>& b) {
  if (!a.X_W.isFinite() || !b.X_W.isFinite())
    throw std::invalid_argument("the pose of a body must be finite");
}

void require(double x, const char* what) {
  if (!(std::isfinite(x) && x >= 0))
    throw std::invalid_argument(std::string(what) + " must be finite and not negative");
}

/// Returns a point of `inner`, under its map. `findEnclosed` gave `number`: a triangle of the
/// enclosed component, or the index of the enclosed convex part.
Vec3 pointOf(const Posed<Body>& inner, std::uint32_t number) {
  const Body& body = inner.shape;
  return inner.X_W *
         (body.isMesh() ? body.mesh().corner(number, 0) : body.parts()[number].points[0]);
}

}  // namespace

std::optional<PrimitivePair> interference(const Posed<Body>& a, const Posed<Body>& b,
                                          QueryContext& context, TreeKind trees, LastPair* last) {
  require(a, b);
  const auto hit =
      withTrees(trees, a.shape, b.shape, [&](auto overlap, const auto& ta, const auto& tb) {
        return interference<decltype(overlap)>(Posed(ta, a.X_W), Posed(tb, b.X_W), context, last);
      });
  if (hit) return hit;
  return findOneInsideOther(a, b, context);
}

std::vector<TriangleContact> contacts(const Posed<Body>& a, const Posed<Body>& b,
                                      QueryContext& context, TreeKind trees) {
  require(a, b);
  if (!a.shape.isMesh() || !b.shape.isMesh())
    throw std::invalid_argument("contacts are between triangles; a convex part has none");
  return withTrees(trees, a.shape, b.shape, [&](auto overlap, const auto& ta, const auto& tb) {
    return contacts<decltype(overlap)>(Posed(ta, a.X_W), Posed(tb, b.X_W), context);
  });
}

Distance distance(const Posed<Body>& a, const Posed<Body>& b, const DistanceOptions& options,
                  QueryContext& context, TreeKind trees, LastPair* last) {
  require(a, b);
  require(options.relative, "a distance's relative error");
  require(options.absolute, "a distance's absolute error");
  if (!(options.upTo >= 0))
    throw std::invalid_argument("DistanceOptions::upTo must be 0 or more; it may be infinite");
  Distance d = surfaceDistance(a, b, options, context, trees, last);
  if (d.distance == 0) return d;
  if (const auto hit = findEnclosed(a, b, context)) {
    const Vec3 p_W = pointOf(b, hit->b);
    d = {0, p_W, p_W, hit->a, hit->b};
  } else if (const auto other = findEnclosed(b, a, context)) {
    const Vec3 p_W = pointOf(a, other->b);
    d = {0, p_W, p_W, other->b, other->a};
  }
  return d;
}

bool closerThan(const Posed<Body>& a, const Posed<Body>& b, double d, QueryContext& context,
                TreeKind trees, LastPair* last) {
  require(a, b);
  require(d, "a tolerance");
  return surfacesCloserThan(a, b, d, context, trees, last) ||
         findOneInsideOther(a, b, context).has_value();
}

}  // namespace corridor
