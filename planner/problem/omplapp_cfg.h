#pragma once

#include <filesystem>

#include "planner/problem/problem.h"

namespace corridor {

/// Reads an OMPL.app benchmark file (`.cfg`) as OMPL.app does: two meshes, placed and recentred by
/// its rules (`readOmplAppMesh`; planner/problem/README.md), start, goal, bounds and objective.
/// Lengths are taken as metres. Keys that have no meaning here are listed in the notes.
/// @throws InputError with all faults.
Problem readOmplAppCfg(const std::filesystem::path& file);

}  // namespace corridor
