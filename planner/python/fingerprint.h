#pragma once

#include <span>
#include <string>

#include "planner/problem/problem.h"

namespace corridor::python {

/// Returns a digest of shapes: all points, radii and triangles, to the last bit.
std::string fingerprintOf(std::span<const PlacedShape> shapes);

/// Returns a digest of all that a proof or solution is about: the shapes of all bodies, the tested
/// pairs, the coordinates with their bounds, the poses of all frames at three configurations,
/// start, goals, margin, paddings and tube. If a change of the files changes one of these, the
/// problem that is read again has another digest.
std::string fingerprintOf(const Problem& problem);

}  // namespace corridor::python
