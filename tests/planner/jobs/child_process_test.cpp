// Tests of work in a child process: its messages arrive, and every way in which the process may end
// is reported.
#include "planner/jobs/child_process.h"

#include <chrono>
#include <csignal>
#include <map>
#include <new>
#include <stdexcept>
#include <thread>
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planner/jobs/executor.h"
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

/// Waits until the child's task has ended. Returns its end.
ChildEnd endOf(ChildProcess& child) {
  while (!child.poll()) ChildProcess::waitForAny({&child}, 1000);
  return child.end();
}

/// Makes a child that sends the number of its process, and how many tasks it has had. Task 7 ends
/// the process, task 8 throws.
ChildProcess counter(std::uint64_t first) {
  return {[count = 0](std::uint64_t task, const Send& send) mutable {
            if (task == 7) std::raise(SIGKILL);
            if (task == 8) throw std::runtime_error("eight");
            send(std::to_string(::getpid()));
            send(std::to_string(++count));
          },
          first,
          {{kLong, kLong}, 0}};
}

TEST(ChildForTasks, OneProcessDoesOneAfterTheOther) {
  ChildProcess child = counter(1);
  const ChildEnd first = endOf(child);
  ASSERT_EQ(first.messages.size(), 2u);
  EXPECT_EQ(first.messages[1], "1");
  for (const char* count : {"2", "3"}) {
    EXPECT_FALSE(child.over());
    ASSERT_TRUE(child.begin(1));
    EXPECT_FALSE(child.hasSent());
    EXPECT_THAT(endOf(child).messages, ElementsAre(first.messages[0], count));
    EXPECT_EQ(child.end().failure, "");
  }
}

TEST(ChildForTasks, ACrashEndsOneTask) {
  ChildProcess crashes = counter(1), throws = counter(8);
  EXPECT_EQ(endOf(crashes).messages.size(), 2u);
  ASSERT_TRUE(crashes.begin(7));
  EXPECT_EQ(endOf(crashes).failure, "killed by signal 9 (Killed)");
  EXPECT_TRUE(crashes.end().messages.empty());  // those of the first task are gone
  EXPECT_EQ(endOf(throws).failure, "eight");
  for (ChildProcess* child : {&crashes, &throws}) {
    EXPECT_TRUE(child->over());
    EXPECT_FALSE(child->begin(1));
  }
}

TEST(ChildForTasks, AChildThatEndedWhileItWaitedTakesNoTask) {
  ChildProcess child = counter(1);
  ::kill(std::stoi(endOf(child).messages[0]), SIGKILL);
  // The task may still be sent before the system has ended the child. Then its end is known later.
  if (child.begin(2)) {
    EXPECT_EQ(endOf(child).failure, "killed by signal 9 (Killed)");
  }
  EXPECT_TRUE(child.over());
}

TEST(ChildForTasks, ATaskThatSendsTooFewMessagesHasFailed) {
  ChildProcess child(
      [](std::uint64_t task, const Send& send) {
        for (std::uint64_t i = 0; i < task; ++i) send("");
      },
      2, {{kLong, kLong}, 0});
  EXPECT_EQ(endOf(child).failure, "");
  ASSERT_TRUE(child.begin(1));
  EXPECT_EQ(endOf(child).failure, "a task sent 1 messages, not 2");
}

TEST(ChildForTasks, TimeLimitHoldsForEachTask) {
  ChildProcess child(
      [](std::uint64_t task, const Send& send) {
        while (task == 2) ::pause();
        send("done");
      },
      1, {{0.5}, 0});
  EXPECT_THAT(endOf(child).messages, ElementsAre("done"));
  std::this_thread::sleep_for(std::chrono::milliseconds(700));  // a wait counts for no task
  ASSERT_TRUE(child.begin(1));
  EXPECT_THAT(endOf(child).messages, ElementsAre("done"));
  ASSERT_TRUE(child.begin(2));
  EXPECT_EQ(endOf(child).failure, "stopped after 0.5 s");
}

TEST(LocalExecutor, GivesTasksToChildrenThatWait) {
  LocalExecutor executor(2, [](std::uint64_t task) { return counter(task); });
  std::map<std::uint64_t, ChildEnd> ends;
  for (std::uint64_t next = 1; ends.size() < 9;) {
    while (next < 10 && executor.underWay() < executor.places())
      ASSERT_TRUE(executor.start(next++));
    for (const TaskEnd& one : executor.wait(1000)) ends[one.task] = one.end;
  }
  int tasks = 0;
  for (const auto& [task, end] : ends) {
    if (task == 7 || task == 8)
      EXPECT_EQ(end.failure, task == 7 ? "killed by signal 9 (Killed)" : "eight");
    else
      tasks += std::stoi(end.messages.back()) > 1;
  }
  // Seven tasks ended well, and at most four processes were made: two at first, and one after each
  // failure.
  EXPECT_GE(tasks, 3);
}

}  // namespace
}  // namespace corridor
