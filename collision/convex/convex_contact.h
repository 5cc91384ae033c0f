#pragma once

#include "collision/convex/convex_cache.h"
#include "collision/convex/convex_set.h"
#include "collision/core/predicate_result.h"

namespace corridor {

/// Returns whether two convex sets, each under its own affine map, share a point.
///
/// `false` is proved in real arithmetic on the given doubles, for any finite maps: a separating
/// axis exists, with all rounding covered. `true` may be wrong only for sets that are apart by less
/// than a band. The band is 2^-44 of the largest coordinate involved (times ‖M‖ if a map x ↦ M x +
/// t is not rigid). For such sets either answer is possible. (PROMISES.md, promise 1.)
///
/// If a number of a set or of a map is not finite, the result is `true`.
/// @param cache  if not null, the cache of the same two sets (convex_cache.h).
PredicateResult convexSetsTouch(const PosedSet& a, const PosedSet& b, ConvexCache* cache = nullptr);

}  // namespace corridor
