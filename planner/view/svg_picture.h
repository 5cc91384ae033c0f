#pragma once

#include <optional>
#include <string>

#include "planner/problem/problem.h"
#include "planner/solve/finish_path.h"
#include "planner/view/view_direction.h"

namespace corridor {

/// Returns a picture of a scene and a path, as an SVG document of at most some hundred KB. The
/// world is seen from above at an angle, unless `from` is set. Robots are drawn at poses along the
/// path, from green (start) to red (goal), with the curve along which a rigid body's reference
/// point, or an arm's last moving link, moves. Links that stand still are drawn once, in blue grey.
/// Everything that stands still and hides the robots is drawn like glass.
/// @param seconds the duration of the motion along the path, which a caption states; unset: the
/// path has no times.
std::string svgPicture(const Problem& problem, const Path& path,
                       const std::optional<ViewDirection>& from = {},
                       const std::optional<double>& seconds = {});

}  // namespace corridor
