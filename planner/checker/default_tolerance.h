#pragma once

#include "planner/problem/problem.h"

namespace corridor {

/// A tolerance for the motions of a problem below which rounding may leave edges undecided; metres.
/// At this tolerance, or a larger one, a free edge with a clearance above twice the tolerance is
/// proved, however large coordinates are beside the bodies (design: contract 2).
///
/// Angles of full circles count as π: larger ones lie outside of this promise.
double roundingTolerance(const Problem& problem);

/// The default tolerance of a problem: `usual`, 1e-7 of the bodies' size, or what rounding needs;
/// but never more than 1000 times the former. (Limits of 10^16 rad would ask for kilometres; values
/// that large are undecided, and all others are proved.)
double defaultTolerance(const Problem& problem, double usual);

}  // namespace corridor
