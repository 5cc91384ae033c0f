#pragma once

#include <span>
#include <string>

#include "planner/model/model.h"

namespace corridor::python {

/// Returns a digest of shapes: all points, radii and triangles, to the last bit.
std::string fingerprintOf(std::span<const PlacedShape> shapes);

/// Returns a digest of all that a proof is about: the shapes of all bodies, which pairs are tested,
/// the coordinates with their bounds, and the poses of all frames at three configurations. A
/// problem that is read again from files that have changed has another one.
std::string fingerprintOf(const Model& model);

}  // namespace corridor::python
