#pragma once

#include <optional>
#include <string>

#include "planner/solve/verify_solution.h"
#include "planner/view/view_direction.h"

namespace corridor {

/// A path to be shown by a page, and the verifier's report on it.
struct ViewedPath {
  Solution solution;
  VerifyReport report;
};

/// Returns an HTML page that shows a problem as a 3D scene, and plays a path of it. The page is one
/// file that loads nothing else (README.md describes what it shows and the layout of its data). The
/// same arguments give the same bytes.
/// @param from the first direction of view; unset: from above at an angle, or from the top for
/// planar problems.
/// @pre the path is in the problem's space and not empty.
std::string viewPage(const Problem& problem, const std::optional<ViewedPath>& path,
                     const std::optional<ViewDirection>& from = {});

}  // namespace corridor
