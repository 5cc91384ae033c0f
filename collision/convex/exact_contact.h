#pragma once

#include <optional>

#include "collision/convex/convex_cache.h"
#include "collision/convex/convex_set.h"

namespace corridor {

/// Returns whether two convex sets without swept spheres or discs share a point, each under its own
/// affine map: exactly, in real arithmetic on the given doubles. Touching is contact.
///
/// Method: GJK proves most pairs to be apart (`convexSetsTouch`). Its last four corners prove most
/// pairs to overlap. A linear program in rationals decides the rest: the normal of a separating
/// plane, on a few corners of the Minkowski difference. The corner that the plane violates most is
/// added until there is none. A pair that needs rationals takes milliseconds.
/// @param cache  if not null, of the same two sets.
/// @throws std::invalid_argument if a set has a sphere or a disc, or a map is not finite, unless
/// GJK proves the sets to be apart.
bool convexHullsTouch(const PosedSet& a, const PosedSet& b, ConvexCache* cache = nullptr);

/// The same, after GJK has found contact: decides whether the hulls do touch.
/// @param found  the cache that this search kept.
/// @throws std::invalid_argument if a set has a sphere or a disc, or a map is not finite.
bool confirmContact(const PosedSet& a, const PosedSet& b, const ConvexCache& found);

/// Returns a common point of the two sets, if the four corners of a cache prove at these poses that
/// the hulls of their points overlap; else nothing. The point is in both sets, up to 2^-46 of the
/// largest coordinate. If two overlapping sets move in small steps, mostly the corners of the last
/// query still prove it, for the price of four determinants.
std::optional<Vec3> provedCommonPoint(const PosedSet& a, const PosedSet& b,
                                      const ConvexCache& corners);

}  // namespace corridor
