#pragma once

#include <filesystem>

#include "planner/problem/problem.h"

namespace corridor {

/// Reads a file of the format corridor-problem-1, with its robot files and meshes.
/// @param cache see `readProblem`. @throws NotedInputError with the faults of all these files.
Problem readProblemYaml(const std::filesystem::path& file, FileCache* cache = nullptr);

}  // namespace corridor
