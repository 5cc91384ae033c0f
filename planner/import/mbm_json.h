#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "planner/problem/problem.h"

namespace corridor {

/// Reads one problem of a MotionBenchMaker set (format mbm-scene-1, JSON). URDF and SRDF are
/// searched for in the folders above the file, the nearest first.
/// @param index a value of `problems[].index` in the set. If `index` is empty, the function throws
/// an InputError whose fault lists the indices of the set.
/// @throws InputError with the faults of the set, the URDF and the SRDF.
Problem readMbmProblem(const std::filesystem::path& file, const std::string& index,
                       FileCache* cache = nullptr);

/// Returns the values of `problems[].index` in a set, in the order of the set. @throws InputError
/// if the set can't be read.
std::vector<std::string> mbmIndices(const std::filesystem::path& file);

}  // namespace corridor
