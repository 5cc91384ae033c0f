#pragma once

#include <optional>
#include <string>

#include "planner/problem/problem.h"
#include "planner/solve/finish_path.h"
#include "planner/view/view_direction.h"

namespace corridor {

/// Returns a picture of a scene and a path, as an SVG document of at most some hundred KB. Unless
/// `from` is set, the world is seen from above at an angle, or from the top if the problem plans
/// only for one planar body. Robots are drawn at poses along the path, from green (start) to red
/// (goal). A curve shows how a rigid body's reference point, or an arm's last moving link, moves.
/// Links that stand still are drawn once, in blue grey. Surfaces that stand still and hide the
/// robots are drawn like glass.
/// @param from the direction of the viewer. @param seconds the duration of the motion along the
/// path, for a caption; unset: no caption.
std::string svgPicture(const Problem& problem, const Path& path,
                       const std::optional<ViewDirection>& from = {},
                       const std::optional<double>& seconds = {});

}  // namespace corridor
