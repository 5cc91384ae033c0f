#include "collision/queries/surface_distance.h"

#include <cmath>

#include "collision/core/rounding.h"
#include "collision/hierarchy/with_volume.h"
#include "collision/queries/distance_obb4.h"

namespace corridor {
namespace {

/// Calls `query` with both bodies' trees of the kind `trees`; binary trees of OBBs replace 4-wide
/// ones where a body is a convex part.
template <class Query>
auto onTrees(TreeKind trees, const Body& a, const Body& b, const Query& query) {
  if (trees == TreeKind::obb4 && !a.part() && !b.part()) return query(a.tree(), b.tree());
  return onVolumeTrees(trees == TreeKind::obb4 ? TreeKind::obbBinary : trees, a, b,
                       [&](auto, const auto& ta, const auto& tb) { return query(ta, tb); });
}

/// A reported distance is off by at most this share of it plus `errorOf`. The share is twice the
/// guaranteed 1e-12, to cover the roundings here.
constexpr double kShare = 2e-12;
/// Returns the absolute error of a reported distance, metres. It covers the guaranteed 4u·S, where
/// S is the largest Σ|m||v| + |t|: at most √3(|v| + |t|) of one body if the maps are nearly rigid.
/// It also covers 3·2^-48 of a swept sphere's radius, if its map is not a rotation bit for bit.
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
