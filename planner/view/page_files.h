#pragma once

#include <string_view>

namespace corridor::view {

/// The text of a file of planner/view/page/, or of three.js ("three.min.js", "OrbitControls.js"),
/// by its name: embedded by CMakeLists.txt (embed.cmake). @throws std::out_of_range for others.
std::string_view pageFile(std::string_view name);

}  // namespace corridor::view
