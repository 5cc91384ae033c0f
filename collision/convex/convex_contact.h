#pragma once

#include "collision/convex/convex_set.h"
#include "collision/core/counters.h"

namespace corridor {

/// Do two convex sets, each under its own map, share a point?
///
/// `false` is a proof in real arithmetic on the doubles given, for any finite maps: a direction
/// along which the two projections, all rounding covered, are apart. `true` outside the band of
/// 2^-44 of the largest coordinate involved (times ‖M‖, where a map isn't rigid) is right; inside
/// it may be either way (design: contract 1).
bool convexSetsTouch(const PosedSet& a, const PosedSet& b, Counters& counters);

}  // namespace corridor
