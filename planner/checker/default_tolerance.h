#pragma once

#include "planner/model/model.h"

namespace corridor {

/// Returns a tolerance, metres, that is large enough for the rounding of a model's motions. With
/// this tolerance or a larger one, every free edge with a clearance above twice the tolerance is
/// proved. This holds even if coordinates are large compared with the bodies.
///
/// The guarantee assumes that the angles of circles are in [−π, π].
/// @param need what the tests have to cover. It decides which pairs are tested.
double roundingTolerance(const Model& model, const Required& need);

/// Returns a model's default tolerance, metres: the larger of `usual` and roundingTolerance(), but
/// at most 1000 times `usual`. Without this upper limit, joint limits of 10^16 rad would need a
/// tolerance of kilometres. With the limit, edges with such large values may be undecided.
/// @param usual the tolerance for coordinates of moderate size, such as Scene::defaultTolerance().
/// @param need as in roundingTolerance().
double defaultTolerance(const Model& model, const Required& need, double usual);

}  // namespace corridor
