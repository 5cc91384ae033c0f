#pragma once

#include <optional>
#include <string>

#include "planner/solve/verify_solution.h"

namespace corridor {

/// A path that a page shows, and what the verifier says of it.
struct ViewedPath {
  Solution solution;
  VerifyReport report;
};

/// A page that shows a problem, and a path of it, as a scene to turn about and to play: HTML in one
/// piece that loads nothing (README.md has what is on it, and how its data is laid out). The same
/// arguments give the same bytes.
/// @pre the path is of the problem's space and not empty.
std::string viewPage(const Problem& problem, const std::optional<ViewedPath>& path);

}  // namespace corridor
