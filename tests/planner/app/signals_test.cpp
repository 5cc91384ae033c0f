// Tests of signals that end the program, in every use of every command: the exit status names the
// signal, each file is complete or absent, and no temporary file or process is left.
#include <csignal>
#include <thread>
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/planner/app/uses.h"

namespace corridor::test {
namespace {

namespace fs = std::filesystem;

void pause(int milliseconds) {
  std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
}

std::vector<Use> named(const std::string& name) {
  for (const Use& use : uses())
    if (use.name == name) return {use};
  return {};
}

class Signals : public UseTest {
 protected:
  /// Waits until this file exists, at most a minute.
  void awaitStart(const std::string& file) const {
    for (int i = 0; i < 6000 && !fs::exists(folder_ / file); ++i) pause(10);
    EXPECT_TRUE(fs::exists(folder_ / file)) << read("err.txt");
  }
  /// Starts the use's `longer` run, and after some milliseconds sends a signal to the program's
  /// process group or to the program alone. @returns how the program ended.
  End endBy(int signal, bool group, int milliseconds) {
    fs::remove_all(folder_ / "out");
    fs::create_directory(folder_ / "out");
    fs::remove(folder_ / "browser.txt");
    const pid_t id = start(GetParam().longer);
    if (!group && !GetParam().startedFile.empty()) awaitStart(GetParam().startedFile);
    pause(milliseconds);
    ::kill(group ? -id : id, signal);
    return wait(id);
  }
};

TEST_P(Signals, EndTheProgramCleanly) {
  const Use& use = GetParam();
  learnWhole(use);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP})
    for (const int delay : {5, 120}) {
      const bool group =
          delay ==
          5;  // the signal goes to the group, as from a terminal; else to the program alone
      SCOPED_TRACE(std::string(::strsignal(signal)) + " after " + std::to_string(delay) + " ms");
      End end;
      // On a fast machine the run may end before the signal. Then the run is repeated with an
      // earlier signal.
      for (int ms = delay * kSlowdown; ms > 0 && end.status < 2; ms /= 2)
        end = endBy(signal, group, ms);
      EXPECT_EQ(end.status, 128 + signal) << end.err;
      EXPECT_TRUE(end.noChildLeft);
      expectWholeOrNothing(use);
      EXPECT_TRUE(use.keeps || written().empty()) << written()[0];
    }
}

INSTANTIATE_TEST_SUITE_P(Uses, Signals, testing::ValuesIn(uses()),
                         [](const auto& use) { return use.param.name; });

/// The real Chromium has child processes and temporary files that must end with the program.
class RealBrowser : public Signals {};

TEST_P(RealBrowser, EndsWithTheProgram) {
  fs::remove(folder_ / "chromium");
  if (std::system("command -v chromium >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "there is no chromium";
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const pid_t id = start(GetParam().longer);
    const auto profile = [&] {
      for (const auto& entry : fs::directory_iterator(folder_ / "tmp"))
        if (fs::exists(entry.path() / "profile/Default")) return true;
      return false;
    };
    for (int i = 0; i < 6000 && !profile(); ++i) pause(10);
    EXPECT_TRUE(profile()) << read("err.txt");
    ::kill(id, signal);
    const End end = wait(id);
    EXPECT_EQ(end.status, 128 + signal) << end.err;
    EXPECT_TRUE(end.noChildLeft);
    expectWholeOrNothing(GetParam());
    EXPECT_THAT(written(), testing::IsEmpty());
  }
}

INSTANTIATE_TEST_SUITE_P(Uses, RealBrowser, testing::ValuesIn(named("ViewImage")),
                         [](const auto& use) { return use.param.name; });

/// Hours of finished runs must not be lost when a campaign is stopped.
class StoppedCampaign : public Signals {};

TEST_P(StoppedCampaign, WritesWhatIsDone) {
  for (const int signal : {SIGTERM, SIGUSR1}) {  // batch systems send either
    fs::remove_all(folder_ / "out/results");
    const pid_t id = start(GetParam().longer);
    awaitStart(GetParam().startedFile);
    pause(1500 * kSlowdown);
    ::kill(id, signal);
    const End end = wait(id);
    EXPECT_EQ(end.status, 128 + signal);
    EXPECT_THAT(end.err, testing::HasSubstr("--resume continues"));
    EXPECT_GT(lines(read("out/results/runs.csv")).size(), 1u);
    EXPECT_THAT(read("out/results/report.html"), testing::HasSubstr("</html>"));
  }
}

INSTANTIATE_TEST_SUITE_P(Uses, StoppedCampaign, testing::ValuesIn(named("BenchmarkOutput")),
                         [](const auto& use) { return use.param.name; });

}  // namespace
}  // namespace corridor::test
