// Tests of planner/app/interrupt.h, in child processes that send signals to themselves.
#include "planner/app/interrupt.h"

#include <chrono>
#include <csignal>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include <gtest/gtest.h>

namespace corridor::app {
namespace {

constexpr int kWentOn = 7, kNotReported = 8;

/// A child process sends a signal to itself, and the same signal again after some milliseconds.
/// Returns how the child process ends.
int statusAfterTwo(SecondInterrupt second, int milliseconds, int signal = SIGINT) {
  const pid_t id = ::fork();
  if (id == 0) {
    ::signal(SIGHUP, SIG_DFL);  // the default, even if this test runs under nohup
    const std::atomic<bool>& interrupted = listenForInterrupts(second);
    std::raise(signal);
    if (!interrupted || interruptedStatus() != 128 + signal) ::_exit(kNotReported);
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    std::raise(signal);
    ::_exit(kWentOn);
  }
  int status = 0;
  ::waitpid(id, &status, 0);
  return status;
}

TEST(Interrupt, ASecondSignalEndsOrIsIgnored) {
  // Job scripts repeat SIGUSR1, so it must not end the program at once.
  const int repeated = statusAfterTwo(SecondInterrupt::ends, 600, SIGUSR1);
  EXPECT_TRUE(WIFEXITED(repeated));
  EXPECT_EQ(WEXITSTATUS(repeated), kWentOn);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const int ended = statusAfterTwo(SecondInterrupt::ends, 600, signal);
    EXPECT_TRUE(WIFSIGNALED(ended));
    EXPECT_EQ(WTERMSIG(ended), signal);
    const int ignored = statusAfterTwo(SecondInterrupt::isIgnored, 600, signal);
    EXPECT_TRUE(WIFEXITED(ignored));
    EXPECT_EQ(WEXITSTATUS(ignored), kWentOn);
  }
}

/// A program that nohup(1) started must continue after its terminal is closed.
TEST(Interrupt, NohupKeepsSighupIgnored) {
  const pid_t id = ::fork();
  if (id == 0) {
    ::signal(SIGHUP, SIG_IGN);
    const std::atomic<bool>& interrupted = listenForInterrupts();
    std::raise(SIGHUP);
    ::_exit(interrupted ? kNotReported : kWentOn);
  }
  int status = 0;
  ::waitpid(id, &status, 0);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), kWentOn);
}

/// timeout(1) sends its signal to the program, and then to the program's process group. The two
/// signals must count as one.
TEST(Interrupt, TwoSignalsAtOnceCountAsOne) {
  const int status = statusAfterTwo(SecondInterrupt::ends, 0);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), kWentOn);
}

/// A signal must not make a pending read fail with EINTR.
TEST(Interrupt, ReadsContinueAfterASignal) {
  int pipe[2];
  ASSERT_EQ(::pipe(pipe), 0);
  const pid_t id = ::fork();
  if (id == 0) {
    listenForInterrupts(SecondInterrupt::ends);
    std::thread([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      ::kill(::getpid(), SIGINT);
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      [[maybe_unused]] const auto written = ::write(pipe[1], "x", 1);
    }).detach();
    char c = 0;
    ::_exit(::read(pipe[0], &c, 1) == 1 && c == 'x' ? kWentOn : kNotReported);
  }
  int status = 0;
  ::waitpid(id, &status, 0);
  ::close(pipe[0]);
  ::close(pipe[1]);
  EXPECT_EQ(WEXITSTATUS(status), kWentOn);
}

}  // namespace
}  // namespace corridor::app
