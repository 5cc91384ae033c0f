#pragma once

#include <optional>
#include <string>

#include "planner/problem/problem.h"
#include "planner/solve/finish_path.h"
#include "planner/view/view_direction.h"

namespace corridor {

/// Returns a picture of a scene and a path, as an SVG document of some hundred KB: an image of the
/// scene, and on top of it lines and texts. Unless `from` is set, the world is seen from above at
/// an angle, or from the top if the problem plans only for one planar body. Robots are drawn at
/// poses along the path, from green (start) to red (goal). A curve shows how a rigid body's
/// reference point, or an arm's last moving link, moves. Links that stand still are drawn once, in
/// blue grey. Surfaces that stand still and hide the robots are drawn like glass.
/// @param from the direction of the viewer. @param seconds the duration of the motion along the
/// path, for a caption; unset: no caption.
std::string svgPicture(const Problem& problem, const Path& path,
                       const std::optional<ViewDirection>& from = {},
                       const std::optional<double>& seconds = {});

/// The longer side of a PNG, pixels: usually, and at most.
inline constexpr int kPngSide = 1200, kLongestPngSide = 8000;

/// Returns the same picture as the bytes of a PNG file, without a caption.
/// @param longest the longer side, pixels. @pre from 1 to `kLongestPngSide`
std::string pngPicture(const Problem& problem, const Path& path,
                       const std::optional<ViewDirection>& from = {}, int longest = kPngSide);

}  // namespace corridor
