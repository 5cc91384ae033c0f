#include "collision/queries/surface_distance.h"

#include <cmath>
#include <concepts>

#include "collision/core/rounding.h"
#include "collision/hierarchy/with_trees.h"
#include "collision/queries/distance_obb4.h"

namespace corridor {
namespace {

/// Calls `query` with both bodies' trees of the kind `trees`.
template <class Query>
auto onTrees(TreeKind trees, const Posed<Body>& a, const Posed<Body>& b, LastPair* last,
             const Query& query) {
  return withTrees(trees, a.shape, b.shape, [&]<class Tree>(auto, const Tree& ta, const Tree& tb) {
    const Posed posedA(ta, a.X_W), posedB(tb, b.X_W);
    if constexpr (std::same_as<Tree, Obb4Tree>)
      return query(posedA, posedB, last);
    else
      return query(posedA, posedB);
  });
}

/// A reported distance is off by at most this fraction of itself plus `errorOf`. The fraction is
/// twice the guaranteed 1e-12, to cover the roundings here.
constexpr double kErrorShare = 2e-12;
/// Returns the absolute error of a reported distance, metres. It covers the guaranteed error of
/// 4u·S, where S is the largest Σ|m||v| + |t|. If the maps are nearly rigid, S is at most √3(|v| +
/// |t|) of one of the bodies. It also covers 3·2^-48 of a swept sphere's radius, because the
/// sphere's map may differ from a rotation by rounding.
double errorOf(const Posed<Body>& a, const Posed<Body>& b) {
  return roundedUp(0x1p-45 * (a.shape.radius() + a.X_W.t.cwiseAbs().sum() + b.shape.radius() +
                              b.X_W.t.cwiseAbs().sum()));
}

}  // namespace

Distance surfaceDistance(const Posed<Body>& a, const Posed<Body>& b, const DistanceOptions& options,
                         QueryContext& context, TreeKind trees, LastPair* last) {
  return onTrees(trees, a, b, last, [&](const auto& ta, const auto& tb, auto... known) {
    return distance(ta, tb, options, context, known...);
  });
}

bool surfacesCloserThan(const Posed<Body>& a, const Posed<Body>& b, double d, QueryContext& context,
                        TreeKind trees, LastPair* last) {
  return onTrees(trees, a, b, last, [&](const auto& ta, const auto& tb, auto... known) {
    return closerThan(ta, tb, d, context, known...);
  });
}

double distanceLowerBound(const Posed<Body>& a, const Posed<Body>& b, const Distance& measured,
                          const DistanceOptions& options, QueryContext& context, TreeKind trees) {
  if (!(measured.distance < HUGE_VAL)) return 0;  // an overflow or a NaN proves nothing
  const double above = measured.distance - options.absolute - errorOf(a, b);
  const double lower = roundedDown(above / (1 + options.relative + kErrorShare));
  if (!(lower > 0)) return 0;
  const bool convex = !a.shape.isMesh() || !b.shape.isMesh();
  return convex && surfacesCloserThan(a, b, lower, context, trees) ? 0 : lower;
}

double distanceUpperBound(const Posed<Body>& a, const Posed<Body>& b, const Distance& measured) {
  return roundedUp(measured.distance * (1 + kErrorShare) + errorOf(a, b));
}

}  // namespace corridor
