#pragma once

#include <filesystem>

#include "planner/problem/problem.h"

namespace corridor {

/// Reads an OMPL.app benchmark file (`.cfg`) as OMPL.app does: two meshes, placed and recentred by
/// its rules (`readOmplAppMesh`; planner/problem/README.md), start, goal, bounds and objective.
/// Lengths are read as metres. The notes list the keys that are not used.
/// @throws InputError with all faults.
Problem readOmplAppCfg(const std::filesystem::path& file);

}  // namespace corridor
