#pragma once

#include <filesystem>

#include "planner/problem/problem.h"

namespace corridor {

/// Reads a benchmark file of OMPL.app (`.cfg`) as OMPL.app does. The file gives two meshes, start,
/// goal, bounds and objective. The meshes are placed and recentred by OMPL.app's rules
/// (`readOmplAppMesh`; planner/problem/README.md). Lengths are read as metres. One of the problem's
/// notes lists the keys that are not used.
/// @throws InputError with all faults.
Problem readOmplAppCfg(const std::filesystem::path& file);

}  // namespace corridor
