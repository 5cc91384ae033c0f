#include "planner/robot/run_program.h"

#include <csignal>
#include <filesystem>
#include <fstream>
#include <system_error>

#include <gtest/gtest.h>

#include "collision/core/error.h"
#include "planner/robot/xacro.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using Why = ProgramEnd::Why;

ProgramEnd shell(const std::string& script, double seconds = 60, std::size_t bytes = 1 << 20) {
  return runProgram({.words = {"/bin/sh", "-c", script}, .seconds = seconds, .bytes = bytes});
}

TEST(RunProgram, ReturnsOutputsAndStatus) {
  const ProgramEnd end = shell("echo out; echo err >&2; cat; exit 3");  // stdin is empty
  EXPECT_EQ(end.why, Why::exited);
  EXPECT_EQ(end.exitStatus, 3);
  EXPECT_EQ(end.out, "out\n");
  EXPECT_EQ(end.err, "err\n");
  EXPECT_EQ(shell("kill -9 $$").exitStatus, -1);
  EXPECT_EQ(runProgram({.words = {"/nowhere/program"}}).exitStatus, 127);
  EXPECT_EQ(runProgram({.words = {"/bin/pwd"}, .folder = "/"}).out, "/\n");
  EXPECT_EQ(runProgram({.words = {"/bin/sh", "-c", "echo $A"}, .environment = {"A=b"}}).out, "b\n");
}

TEST(RunProgram, Limits) {
  EXPECT_EQ(shell("sleep 600 & sleep 600", 0.05).why, Why::timedOut);
  EXPECT_EQ(shell("while :; do echo more; done", 60, 1000).why, Why::tooMuchOutput);
  EXPECT_EQ(shell("head -c 2000 /dev/zero", 60, 1000).why, Why::tooMuchOutput);
  const std::atomic<bool> interrupted = true;
  EXPECT_EQ(runProgram({.words = {"/bin/sleep", "600"}, .interrupted = &interrupted}).why,
            Why::interrupted);
}

/// Without its status, a program must not count as successful.
TEST(RunProgram, ThrowsIfTheStatusIsLost) {
  std::signal(SIGCHLD, SIG_IGN);
  EXPECT_THROW(shell("exit 1"), std::system_error);
  std::signal(SIGCHLD, SIG_DFL);
  EXPECT_EQ(shell("exit 1").exitStatus, 1);
}

TEST(RunProgram, FindsProgramsInPath) {
  EXPECT_EQ(findProgram("no such program"), "");
  EXPECT_EQ(findProgram("sh").filename(), "sh");
}

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
