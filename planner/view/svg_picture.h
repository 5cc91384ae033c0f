#pragma once

#include <string>

#include "planner/solve/finish_path.h"

namespace corridor {

/// A picture of a scene and a path, as an SVG document of at most some hundred KB: the world seen
/// from above at an angle, the robots at poses along the path from green (start) to red (goal), and
/// the way of a rigid body's reference point, or of an arm's last link. World that hides the robot
/// is drawn like glass.
std::string svgPicture(const Problem& problem, const Path& path);

}  // namespace corridor
