#pragma once

#include <filesystem>
#include <string>

#include "planner/problem/problem.h"

namespace corridor::test {

/// Reads one of the project's problems, by the name of its folder.
inline Problem ownProblem(const std::string& name) {
  return readProblem(std::filesystem::path(CORRIDOR_SOURCE_DIR) / "problems" / name);
}

}  // namespace corridor::test
