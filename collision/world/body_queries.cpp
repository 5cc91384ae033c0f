#include "collision/world/body_queries.h"

#include <cmath>
#include <stdexcept>

#include "collision/hierarchy/with_volume.h"
#include "collision/queries/containment.h"
#include "collision/queries/interference.h"
#include "collision/queries/interference_obb4.h"
#include "collision/queries/surface_distance.h"

namespace corridor {
namespace {

void require(const Transform& X_WA, const Transform& X_WB) {
  if (!X_WA.isFinite() || !X_WB.isFinite())
    throw std::invalid_argument("the pose of a body must be finite");
}

void require(double x, const char* what) {
  if (!(std::isfinite(x) && x >= 0))
    throw std::invalid_argument(std::string(what) + " must be finite and not negative");
}

/// Returns a point of the part of `inner` that `enclosed` found.
Vec3 pointOf(const Body& inner, std::uint32_t number, const Transform& X_WI) {
  return X_WI * (inner.part() ? inner.part()->points[0] : inner.mesh().corner(number, 0));
}

}  // namespace

std::optional<TrianglePair> interference(const Body& a, const Transform& X_WA, const Body& b,
                                         const Transform& X_WB, QueryContext& context,
                                         TreeKind trees) {
  require(X_WA, X_WB);
  const auto hit =
      trees == TreeKind::obb4
          ? interference(a.tree(), X_WA, b.tree(), X_WB, context)
          : onVolumeTrees(trees, a, b, [&](auto overlap, const auto& ta, const auto& tb) {
              return interference<decltype(overlap)>(ta, X_WA, tb, X_WB, context);
            });
  if (hit) return hit;
  return insideEachOther(a, X_WA, b, X_WB, context);
}

Distance distance(const Body& a, const Transform& X_WA, const Body& b, const Transform& X_WB,
                  const DistanceOptions& options, QueryContext& context, TreeKind trees) {
  require(X_WA, X_WB);
  require(options.relative, "a distance's relative error");
  require(options.absolute, "a distance's absolute error");
  Distance d = surfaceDistance(a, X_WA, b, X_WB, options, context, trees);
  if (d.distance == 0) return d;
  if (const auto hit = enclosed(a, X_WA, b, X_WB, context)) {
    const Vec3 p_W = pointOf(b, hit->b, X_WB);
    d = {0, p_W, p_W, hit->a, hit->b};
  } else if (const auto other = enclosed(b, X_WB, a, X_WA, context)) {
    const Vec3 p_W = pointOf(a, other->b, X_WA);
    d = {0, p_W, p_W, other->b, other->a};
  }
  return d;
}

bool closerThan(const Body& a, const Transform& X_WA, const Body& b, const Transform& X_WB,
                double d, QueryContext& context, TreeKind trees) {
  require(X_WA, X_WB);
  require(d, "a tolerance");
  return surfacesCloserThan(a, X_WA, b, X_WB, d, context, trees) ||
         insideEachOther(a, X_WA, b, X_WB, context).has_value();
}

}  // namespace corridor
