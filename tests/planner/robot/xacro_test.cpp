#include "planner/robot/xacro.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "collision/core/error.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

TEST(Xacro, HasATimeLimit) {
  const std::filesystem::path folder = test::newFolder();
  std::ofstream(folder / "r.xacro") << "<robot/>";
  std::ofstream(folder / "xacro") << "#!/bin/sh\nexec sleep 600\n";
  std::filesystem::permissions(folder / "xacro", std::filesystem::perms::owner_all);
  const char* const path = std::getenv("PATH");
  const std::string before = path ? path : "";
  ::setenv("PATH", (folder.string() + ":" + before).c_str(), 1);
  std::string said;
  try {
    expandXacro(folder / "r.xacro", {}, 0.25);
  } catch (const InputError& error) {
    said = error.what();
  }
  ::setenv("PATH", before.c_str(), 1);
  EXPECT_EQ(said, (folder / "r.xacro").string() + ": xacro took more than 0.25 s and was stopped");
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace corridor
