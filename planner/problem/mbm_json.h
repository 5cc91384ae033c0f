#pragma once

#include <filesystem>
#include <string>

#include "planner/problem/problem.h"

namespace corridor {

/// Reads one problem of a MotionBenchMaker set (format mbm-scene-1, JSON). URDF and SRDF are looked
/// for in the folders above the file, the nearest first.
/// @param index as `problems[].index` has it; empty: none was given, and the fault tells which
/// there are.
/// @throws InputError.
Problem readMbmProblem(const std::filesystem::path& file, const std::string& index);

}  // namespace corridor
