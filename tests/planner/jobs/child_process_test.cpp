// Tests of work in a child process: its messages arrive, and every way in which the process may end
// is reported.
#include "planner/jobs/child_process.h"

#include <chrono>
#include <csignal>
#include <new>
#include <stdexcept>
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/support.h"

namespace corridor {
namespace {

using testing::ElementsAre;
using Send = std::function<void(const std::string&)>;

constexpr double kLong = 600;

TEST(InChild, AllMessagesArriveLongOnesToo) {
  const std::string text(3'000'000, 'x');  // more than a pipe holds
  int here = 0;
  const ChildEnd end = inChild(
      [&](const Send& send) {
        here = 1;
        send(text);
        send("");
      },
      {{kLong, kLong}, 0});
  EXPECT_EQ(end.failure, "");
  ASSERT_EQ(end.messages.size(), 2u);
  EXPECT_TRUE(end.messages[0] == text);
  EXPECT_EQ(end.messages[1], "");
  EXPECT_EQ(here, 0);  // the work ran in another process
}

TEST(InChild, SentMessagesArriveDespiteASignal) {
  const ChildEnd end = inChild(
      [](const Send& send) {
        send("first");
        std::raise(SIGKILL);
        send("second");
      },
      {{kLong, kLong}, 0});
  EXPECT_THAT(end.messages, ElementsAre("first"));
  EXPECT_EQ(end.failure, "killed by signal 9 (Killed)");
}

TEST(InChild, OtherEnds) {
  const auto failure = [](const std::function<void()>& work) {
    return inChild([&](const Send&) { work(); }, {{kLong}, 0}).failure;
  };
  EXPECT_EQ(failure([] { ::_exit(3); }), "ended early, with exit status 3");
  EXPECT_EQ(failure([] {}), "ended early, with exit status 0");
  EXPECT_EQ(failure([] { throw std::runtime_error("two\nlines"); }), "two lines");
  EXPECT_EQ(failure([] { throw std::bad_alloc(); }), "out of memory");
}

TEST(InChild, TimeLimitHoldsForEachMessage) {
  const auto start = std::chrono::steady_clock::now();
  const ChildEnd end = inChild(
      [](const Send& send) {
        send("first");
        for (;;) ::pause();
      },
      {{kLong, 0.5}, 0});
  EXPECT_THAT(end.messages, ElementsAre("first"));
  EXPECT_EQ(end.failure, "stopped after 0.5 s");
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(60));
}

TEST(InChild, AnInterruptEndsIt) {
  const std::atomic<bool> interrupted = true;
  const ChildEnd end = inChild(
      [](const Send&) {
        for (;;) ::pause();
      },
      {{kLong}, 0}, &interrupted);
  EXPECT_TRUE(end.messages.empty());
  EXPECT_EQ(end.failure, "interrupted");
}

TEST(InChild, NoMoreMemoryThanAllowed) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "AddressSanitizer ends the process where memory ends";
#endif
  const auto allocate = [](std::size_t bytes) {
    return [bytes](const Send& send) {
      std::vector<char> all(bytes, 1);
      send(std::string(1, all.back() == 1 ? 'y' : 'n'));
    };
  };
  constexpr std::size_t kMegabyte = 1 << 20;
  EXPECT_THAT(inChild(allocate(50 * kMegabyte), {{kLong}, 100 * kMegabyte}).messages,
              ElementsAre("y"));
  EXPECT_EQ(inChild(allocate(150 * kMegabyte), {{kLong}, 100 * kMegabyte}).failure,
            "out of memory");
}

}  // namespace
}  // namespace corridor
