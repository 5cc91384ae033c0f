#pragma once

#include <string_view>

namespace corridor::view {

/// Returns the text of a file by its name: a file of planner/view/page/, or of three.js
/// ("three.min.js", "OrbitControls.js"). CMakeLists.txt embeds these files (embed.cmake).
/// @throws std::out_of_range for other names.
std::string_view pageFile(std::string_view name);

}  // namespace corridor::view
