#pragma once

#include <optional>
#include <string>

#include "planner/solve/verify_solution.h"
#include "planner/view/view_direction.h"

namespace corridor {

/// A path or a trajectory to be shown by a page, and the verifier's report on it.
struct ViewedPath {
  Solution solution;  ///< a trajectory: only `path`, its rows
  VerifyReport report;
  /// A trajectory: the curve through its rows, as curveOf returns it. It is played at its true
  /// speed if `report` has its times.
  std::optional<Curve> curve;
  /// Limits for the plots of a trajectory, one element for each number: m/s, rad/s; m/s², rad/s².
  /// An infinite element, or an empty vector, is no limit. For the position of a planar or floating
  /// joint, the element of its first number limits the vector's length.
  Configuration velocityLimits, accelerationLimits;
  std::string limitsText;  ///< the shares of the limits over time (`report.limits`), one line
};

/// Returns an HTML page that shows a problem as a 3D scene, and plays a path or trajectory of it.
/// The page is one file that loads nothing else (README.md describes what it shows and the layout
/// of its data). The same arguments give the same bytes.
/// @param from the first direction of view; unset: from above at an angle, or from the top for
/// planar problems.
/// @pre the path is in the problem's space and not empty.
std::string viewPage(const Problem& problem, const std::optional<ViewedPath>& path,
                     const std::optional<ViewDirection>& from = {});

}  // namespace corridor
