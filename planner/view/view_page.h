#pragma once

#include <optional>
#include <string>

#include "planner/solve/verify_solution.h"
#include "planner/view/view_direction.h"

namespace corridor {

/// A path or a trajectory to be shown by a page, and the verifier's report on it.
struct ViewedPath {
  Solution solution;  ///< for a trajectory, only `path` is set, to its rows
  VerifyReport report;
  /// For a trajectory: the curve through its rows, as `curveOf` returns it. The page plays it at
  /// its true speed if `report` has times. Unset for a path.
  std::optional<Curve> curve;
  /// Limits for the plots of a trajectory, one element for each component of a configuration: in
  /// m/s or rad/s, and in m/s² or rad/s². An infinite element, or an empty vector, means that there
  /// is no limit. For the position of a planar or floating joint, the element of its first
  /// component limits the length of the vector.
  Configuration velocityLimits, accelerationLimits;
  std::string limitsText;  ///< one line of text about `report.limits`: how much of each limit over
                           ///< time is used
};

/// Returns an HTML page that shows a problem as a 3D scene, and plays a path or trajectory of it.
/// The page is one file that loads nothing else. README.md describes what the page shows, and the
/// layout of its data. The same arguments give the same bytes.
/// @param from the first direction of view; unset: from above at an angle, or from the top for
/// planar problems.
/// @pre The path is in the problem's space and not empty.
std::string viewPage(const Problem& problem, const std::optional<ViewedPath>& path,
                     const std::optional<ViewDirection>& from = {});

}  // namespace corridor
