#pragma once

#include <string>

#include "planner/problem/problem.h"

namespace corridor {

/// Sets the bounds of the reference point to the bounding box of the world's triangles (SE2: x and
/// y).
void setBoundsOfWorld(Problem& problem);

/// Enlarges the bounds to contain start and goal. @returns whether that was needed.
bool enlargeBounds(Problem& problem);

/// What is wrong with the bounds themselves, or "".
std::string whyBadBounds(const Problem& problem);

/// Why a pose's position is no legal one ("outside of the bounds: x = 9 is not in [0, 1]"), or "".
std::string whyOutside(const Problem& problem, const RigidPose& pose);

}  // namespace corridor
