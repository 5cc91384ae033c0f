#pragma once

#include <optional>

#include "collision/convex/convex_set.h"

namespace corridor {

/// Decides contact of two convex sets in double, if double suffices; else returns nullopt. The
/// function is the first step of `convexSetsTouch`, with the same guarantee: `false` is proved in
/// real arithmetic, and `true` is wrong only for sets that are apart by less than the band
/// (`convexSetsTouch`).
///
/// Method: the closest points of two segments, and of a point and a box, in closed form; two boxes
/// by separating axes (Gottschalk, Lin, Manocha 1996); GJK for all other sets. To prove separation,
/// each method finds a direction, and the projections of both sets onto this direction then prove
/// the gap. If a set is a `Polytope` or a `DobkinKirkpatrick`, the function returns nullopt.
std::optional<bool> quickContact(const PosedSet& a, const PosedSet& b);

}  // namespace corridor
