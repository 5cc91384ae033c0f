#include "collision/core/external_program.h"

#include <csignal>
#include <fcntl.h>
#include <unistd.h>

#include <gtest/gtest.h>

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
  EXPECT_EQ(shell("kill -9 $$").signal, 9);
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
TEST(RunProgram, SaysThatTheStatusIsLost) {
  std::signal(SIGCHLD, SIG_IGN);
  const ProgramEnd end = shell("echo out; exit 1");
  std::signal(SIGCHLD, SIG_DFL);
  EXPECT_EQ(end.why, Why::statusLost);
  EXPECT_EQ(end.exitStatus, -1);
  EXPECT_EQ(end.out, "out\n");
  EXPECT_EQ(shell("exit 1").exitStatus, 1);
}

/// A process such as a daemon may have closed its standard streams.
TEST(RunProgram, WithoutStandardStreams) {
  const int in = ::dup(STDIN_FILENO), out = ::dup(STDOUT_FILENO);
  ::close(STDIN_FILENO);
  ::close(STDOUT_FILENO);
  const ProgramEnd end = shell("echo out; cat; exit 3");
  ::dup2(in, STDIN_FILENO);
  ::dup2(out, STDOUT_FILENO);
  ::close(in);
  ::close(out);
  EXPECT_EQ(end.exitStatus, 3);
  EXPECT_EQ(end.out, "out\n");
}

TEST(RunProgram, FindsProgramsInPath) {
  EXPECT_EQ(findProgram("no such program"), "");
  EXPECT_EQ(findProgram("sh").filename(), "sh");
}

}  // namespace
}  // namespace corridor
