#include "collision/queries/surface_distance.h"

#include <cmath>

#include "collision/core/rounding.h"
#include "collision/hierarchy/with_volume.h"
#include "collision/queries/distance_wide.h"

namespace corridor {
namespace {

/// Calls `query` with both bodies' trees.
template <class Query>
auto onTrees(TreeKind trees, const Body& a, const Body& b, const Query& query) {
  if (trees == TreeKind::wideObb && !a.part() && !b.part()) return query(a.tree(), b.tree());
  return onVolumeTrees(trees == TreeKind::wideObb ? TreeKind::obb : trees, a, b,
                       [&](auto, const auto& ta, const auto& tb) { return query(ta, tb); });
}

/// What a distance told may be off by, beside a share `kShare` of it: 4u·S by its promise, S the
/// largest Σ|m||v| + |t|, at most √3(|v| + |t|) of one body where maps are nearly rigid; and
/// 3·2^-48 of a ball's radius, where its map is not a rotation bit for bit. Metres.
constexpr double kShare = 2e-12;  // twice the promised 1e-12, for the roundings here
double errorOf(const Body& a, const Transform& X_WA, const Body& b, const Transform& X_WB) {
  return roundedUp(0x1p-45 *
                   (a.radius() + X_WA.t.cwiseAbs().sum() + b.radius() + X_WB.t.cwiseAbs().sum()));
}

}  // namespace

Distance surfaceDistance(const Body& a, const Transform& X_WA, const Body& b, const Transform& X_WB,
                         const DistanceOptions& options, QueryContext& context, TreeKind trees) {
  return onTrees(trees, a, b, [&](const auto& ta, const auto& tb) {
    return distance(ta, X_WA, tb, X_WB, options, context);
  });
}

bool surfacesCloserThan(const Body& a, const Transform& X_WA, const Body& b, const Transform& X_WB,
                        double d, QueryContext& context, TreeKind trees) {
  return onTrees(trees, a, b, [&](const auto& ta, const auto& tb) {
    return closerThan(ta, X_WA, tb, X_WB, d, context);
  });
}

double provedDistance(const Body& a, const Transform& X_WA, const Body& b, const Transform& X_WB,
                      const Distance& told, const DistanceOptions& options, QueryContext& context,
                      TreeKind trees) {
  if (!(told.distance < HUGE_VAL)) return 0;  // an overflow proves nothing; nor does a NaN
  const double above = told.distance - options.absolute - errorOf(a, X_WA, b, X_WB);
  const double lower = roundedDown(above / (1 + options.relative + kShare));
  if (!(lower > 0)) return 0;
  const bool convex = a.part() || b.part();
  return convex && surfacesCloserThan(a, X_WA, b, X_WB, lower, context, trees) ? 0 : lower;
}

double distanceFromAbove(const Body& a, const Transform& X_WA, const Body& b, const Transform& X_WB,
                         const Distance& told) {
  return roundedUp(told.distance * (1 + kShare) + errorOf(a, X_WA, b, X_WB));
}

}  // namespace corridor
