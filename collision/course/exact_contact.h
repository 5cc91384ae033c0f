#pragma once

#include <optional>

#include "collision/convex/convex_cache.h"
#include "collision/convex/convex_set.h"

namespace corridor {

/// Returns whether two convex sets without swept spheres or discs, each under its own affine map,
/// share a point. The answer is exact, in real arithmetic on the given doubles. Touching is
/// contact.
///
/// Method: GJK (`convexSetsTouch`) proves that most disjoint pairs are apart. For most other pairs,
/// the four corners with which GJK ends prove an overlap (`provedCommonPoint`). A linear program in
/// rationals decides the remaining pairs. It searches for the normal of a separating plane, from a
/// few corners of the Minkowski difference. In each round, the corner that violates the plane most
/// is added, until no corner violates the plane. A pair that needs rationals takes milliseconds.
/// @param cache  if not null, the cache of the same two sets (convex_cache.h).
/// @throws std::invalid_argument if a set has a sphere or a disc, or a map is not finite. (If GJK
/// proves that the sets are apart, these conditions are not tested.)
bool convexHullsTouch(const PosedSet& a, const PosedSet& b, ConvexCache* cache = nullptr);

/// The second step of `convexHullsTouch`, for sets for which `convexSetsTouch` has returned true:
/// decides exactly whether they share a point.
/// @param found  the cache that this call of `convexSetsTouch` has filled.
/// @throws std::invalid_argument if a set has a sphere or a disc, or a map is not finite.
bool confirmContact(const PosedSet& a, const PosedSet& b, const ConvexCache& found);

/// Returns a common point of the two sets if the four corners of a cache prove, at these poses,
/// that the hulls of the sets' points overlap. Otherwise returns nothing. The point is in both
/// sets, up to 2^-46 of the largest coordinate. If two overlapping sets move in small steps, the
/// corners of the previous query mostly still prove the overlap, at the cost of four determinants.
std::optional<Vec3> provedCommonPoint(const PosedSet& a, const PosedSet& b,
                                      const ConvexCache& corners);

}  // namespace corridor
