#pragma once

#include "planner/problem/problem.h"

namespace corridor {

/// A tolerance for the motions of a problem below which rounding may leave edges undecided; metres.
/// At this tolerance, or a larger one, a free edge with a clearance above twice the tolerance is
/// proved, however large coordinates are beside the bodies (design: contract 2).
///
/// The default tolerance of a problem is the larger one of this and `Scene::defaultTolerance()`.
/// Infinite lengths (a slide that mimics a full circle) count as 0: nothing can be promised there.
double roundingTolerance(const Problem& problem);

}  // namespace corridor
