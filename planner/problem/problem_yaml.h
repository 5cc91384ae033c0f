#pragma once

#include <filesystem>

#include "planner/problem/problem.h"

namespace corridor {

/// Reads a file of the format corridor-problem-1, with its robot file and meshes. @throws
/// InputError with all their faults.
Problem readProblemYaml(const std::filesystem::path& file);

}  // namespace corridor
