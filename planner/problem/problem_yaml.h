#pragma once

#include <filesystem>

#include "planner/problem/problem.h"

namespace corridor {

/// Reads a file of the format corridor-problem-1, with its robot files and meshes.
/// @throws NotedInputError with the faults of all these files.
Problem readProblemYaml(const std::filesystem::path& file);

}  // namespace corridor
