#pragma once

#include <string>

#include "planner/problem/problem.h"
#include "planner/solve/finish_path.h"

namespace corridor {

/// Returns a picture of a scene and a path, as an SVG document of at most some hundred KB. The
/// world is seen from above at an angle. Robots are drawn at poses along the path, from green
/// (start) to red (goal), with the curve along which a rigid body's reference point, or an arm's
/// last link, moves. Parts of the world that hide the robots are drawn like glass.
std::string svgPicture(const Problem& problem, const Path& path);

}  // namespace corridor
