#pragma once

#include <filesystem>
#include <string>

#include "planner/problem/problem.h"

namespace corridor::test {

/// A problem that comes with the project, by the name of its folder.
inline Problem ownProblem(const std::string& name) {
  return readProblem(std::filesystem::path(CORRIDOR_SOURCE_DIR) / "problems" / name);
}

}  // namespace corridor::test
