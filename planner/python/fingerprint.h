#pragma once

#include <span>
#include <string>

#include "planner/problem/problem.h"

namespace corridor::python {

/// Returns a digest of shapes: all points, radii and triangles, to the last bit.
std::string fingerprintOf(std::span<const PlacedShape> shapes);

/// Returns a digest of all that a proof or solution is about: the shapes of all bodies, the tested
/// pairs, the coordinates with their bounds, the poses of all frames at three configurations,
/// start, goals, margin, paddings and tube. If the files change so that one of these differs, the
/// problem that is read from the changed files has another digest.
std::string fingerprintOf(const Problem& problem);

}  // namespace corridor::python
