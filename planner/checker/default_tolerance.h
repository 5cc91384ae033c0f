#pragma once

#include "planner/model/model.h"

namespace corridor {

/// Returns the tolerance, metres, that the rounding of a model's motions needs. At this tolerance
/// or a larger one, every free edge with a clearance above twice the tolerance is proved. This
/// holds even if coordinates are large compared with the bodies.
///
/// Angles of circles count as π; larger ones are outside of this guarantee.
double roundingTolerance(const Model& model);

/// Returns a model's default tolerance, metres: the larger of `usual` (1e-7 of the bodies' size)
/// and roundingTolerance(), but at most 1000 times `usual`. Without that limit, joint limits of
/// 10^16 rad would need kilometres. With it, edges with values that large are undecided, and all
/// others are proved.
double defaultTolerance(const Model& model, double usual);

}  // namespace corridor
