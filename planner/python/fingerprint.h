#pragma once

#include <span>
#include <string>

#include "planner/problem/problem.h"

namespace corridor::python {

/// Returns a digest of shapes: all points, radii and triangles, to the last bit.
std::string fingerprintOf(std::span<const PlacedShape> shapes);

/// Returns a digest of all that a proof or solution is about: the shapes of all bodies, which pairs
/// are tested, the coordinates with their bounds, the poses of all frames at three configurations;
/// start, goals, margin, paddings and tube. A problem that is read again from files that have
/// changed in one of these has another digest.
std::string fingerprintOf(const Problem& problem);

}  // namespace corridor::python
