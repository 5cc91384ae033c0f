// Tests of how rank 0 hands out tasks to other ranks, without MPI: the ranks are threads, and their
// messages go through queues. tests/planner/app/mpi_command_test.cpp tests the program under
// mpirun.
#include "planner/jobs/rank_executor.h"

#include <algorithm>
#include <atomic>
#include <csignal>
#include <map>
#include <mutex>
#include <stdexcept>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "collision/core/error.h"

namespace corridor {
namespace {

using testing::EndsWith;
using testing::StartsWith;

/// The queues of messages, one for each rank.
struct Post {
  explicit Post(int ranks) : boxes(static_cast<std::size_t>(ranks)) {}
  std::mutex mutex;
  std::vector<std::deque<RankMessage>> boxes;
};

class ThreadRanks final : public Ranks {
 public:
  ThreadRanks(Post& post, int rank) : post_(post), rank_(rank) {}
  int rank() const override { return rank_; }
  int size() const override { return static_cast<int>(post_.boxes.size()); }
  void send(int to, std::string text) override {
    const std::lock_guard lock(post_.mutex);
    post_.boxes[static_cast<std::size_t>(to)].push_back({rank_, std::move(text)});
  }
  std::optional<RankMessage> receive() override {
    const std::lock_guard lock(post_.mutex);
    auto& box = post_.boxes[static_cast<std::size_t>(rank_)];
    if (box.empty()) return std::nullopt;
    const RankMessage message = box.front();
    box.pop_front();
    return message;
  }

 private:
  Post& post_;
  int rank_;
};

/// An executor without processes. Tasks below 1000 end at once. Tasks from 1000 to 1999 end only
/// when `stop` kills them. Tasks from 2000 to 2999 are not killed by `stop`, but end after it.
/// Tasks from 3000 on can't be started (`start` returns false), and for task 13 `start` throws.
class FakeExecutor final : public Executor {
 public:
  explicit FakeExecutor(std::size_t places) : places_(places) {}
  std::size_t places() const override { return places_; }
  std::size_t underWay() const override { return tasks_.size(); }
  bool start(std::uint64_t task) override {
    if (task == 13) throw std::runtime_error("no room");
    if (task >= 3000) return false;
    tasks_.push_back(task);
    EXPECT_LE(tasks_.size(), places_);
    return true;
  }
  std::vector<TaskEnd> wait(int milliseconds) override {
    std::vector<TaskEnd> ends;
    for (const std::uint64_t task : tasks_)
      if (task < 1000)
        ends.push_back({task, {{"", "result\nof " + std::to_string(task)}, task % 2 ? "odd" : ""}});
      else if (task >= 2000 && stopped_)
        ends.push_back({task, {{}, "late"}});
    std::erase_if(tasks_,
                  [&](std::uint64_t task) { return task < 1000 || (task >= 2000 && stopped_); });
    if (ends.empty()) std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    return ends;
  }
  std::vector<std::uint64_t> stop() override {
    std::vector<std::uint64_t> killed;
    std::copy_if(tasks_.begin(), tasks_.end(), std::back_inserter(killed),
                 [](std::uint64_t task) { return task < 2000; });
    std::erase_if(tasks_, [](std::uint64_t task) { return task < 2000; });
    stopped_ = true;
    return killed;
  }

 private:
  std::size_t places_;
  bool stopped_ = false;
  std::vector<std::uint64_t> tasks_;
};

/// Runs ranks 1, 2, … in threads. The threads end when rank 0's executor is destroyed.
class RankTest : public testing::Test {
 protected:
  static constexpr int kRanks = 4;
  RankTest() {
    for (int rank = 1; rank < kRanks; ++rank)
      threads_.emplace_back([this, rank] {
        ThreadRanks ranks(post_, rank);
        serveRanks(
            ranks,
            [rank](const std::string& text) {
              if (text == "late fault" && rank == 3) {
                std::this_thread::sleep_for(std::chrono::milliseconds(50));
                throw std::runtime_error("other files");
              }
              return std::make_unique<FakeExecutor>(2);
            },
            [this, rank] { return rank == 2 ? signal_.load() : 0; });
      });
  }
  ~RankTest() override {
    executor_.reset();
    for (std::thread& thread : threads_) thread.join();
  }

  Post post_{kRanks};
  ThreadRanks zero_{post_, 0};
  std::atomic<int> signal_ = 0;
  std::atomic<bool> interrupted_ = false;
  std::optional<RankExecutor> executor_{std::in_place, zero_, 2};
  std::vector<std::thread> threads_;
};

TEST_F(RankTest, DoesEachTaskOnceByTwoMessages) {
  executor_->begin("set up", interrupted_);
  EXPECT_EQ(executor_->places(), 6u);
  std::map<std::uint64_t, TaskEnd> ends;
  const std::uint64_t before = executor_->messages();
  for (std::uint64_t next = 100; next < 600 || executor_->underWay() > 0;) {
    while (next < 600 && executor_->underWay() < executor_->places()) executor_->start(next++);
    for (TaskEnd& one : executor_->wait(200))
      EXPECT_TRUE(ends.emplace(one.task, std::move(one)).second);
  }
  EXPECT_EQ(ends.size(), 500u);
  EXPECT_EQ(executor_->messages() - before, 2u * 500);
  for (const auto& [task, one] : ends) {
    ASSERT_EQ(one.end.messages.size(), 2u);
    EXPECT_EQ(one.end.messages[1], "result\nof " + std::to_string(task));
    EXPECT_EQ(one.end.failure, task % 2 ? "odd" : "");
  }
}

TEST_F(RankTest, StopKillsWhatMayBeKilled) {
  executor_->begin("set up", interrupted_);
  for (const std::uint64_t task : {1000, 1001, 1002, 1003, 2000, 3000}) executor_->start(task);
  EXPECT_TRUE(executor_->wait(50).empty());
  executor_->stop();
  std::vector<TaskEnd> ends;
  for (int i = 0; i < 200 && executor_->underWay() > 0; ++i)
    for (const TaskEnd& one : executor_->wait(200)) ends.push_back(one);
  EXPECT_EQ(executor_->underWay(), 0u);
  ASSERT_EQ(ends.size(), 1u);
  EXPECT_EQ(ends[0].task, 2000u);
  EXPECT_EQ(ends[0].end.failure, "late");
  EXPECT_TRUE(ends[0].end.messages.empty());
}

volatile std::sig_atomic_t received = 0;

TEST_F(RankTest, ASignalAtARankArrivesAtRank0) {
  executor_->begin("set up", interrupted_);
  const auto old = std::signal(SIGUSR2, [](int number) { received = number; });
  signal_ = SIGUSR2;
  for (int i = 0; i < 200 && received == 0; ++i) executor_->wait(50);
  std::signal(SIGUSR2, old);
  EXPECT_EQ(received, SIGUSR2);
}

TEST_F(RankTest, FaultsOfRanksEndTheJob) {
  const auto complaint = [&] {
    try {
      for (int i = 0; i < 200; ++i) executor_->wait(50);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  executor_->begin("set up", interrupted_);
  executor_->start(13);
  const std::string fault = complaint();
  EXPECT_THAT(fault, StartsWith("rank 1: "));
  EXPECT_THAT(fault, EndsWith(": no room"));
}

/// The end of a task and a fault have both arrived when rank 0 looks for messages. The end of the
/// task must not be lost.
TEST_F(RankTest, TasksThatEndedBeforeAFaultAreReturned) {
  executor_->begin("set up", interrupted_);
  executor_->start(100);
  executor_->start(13);
  const auto arrived = [&] {
    const std::lock_guard lock(post_.mutex);
    return post_.boxes[0].size();
  };
  while (arrived() < 2) std::this_thread::yield();
  const std::vector<TaskEnd> ends = executor_->wait(50);
  ASSERT_EQ(ends.size(), 1u);
  EXPECT_EQ(ends[0].task, 100u);
  EXPECT_THROW(executor_->wait(50), InputError);
}

/// No task begins if a rank can't do its part, however long that rank takes to notice.
TEST_F(RankTest, WaitsForTheSetUpOfAllRanks) {
  try {
    executor_->begin("late fault", interrupted_);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), StartsWith("rank 3: "));
    EXPECT_THAT(error.what(), EndsWith(": other files"));
  }
}

/// After an interrupt, `begin` does not wait for a rank that takes long to set up.
TEST_F(RankTest, AnInterruptEndsTheWaitForTheSetUp) {
  interrupted_ = true;
  executor_->begin("late fault", interrupted_);
  EXPECT_EQ(executor_->underWay(), 0u);
}

/// If `begin` was not called, the other ranks end without work.
TEST_F(RankTest, EndsWithoutWork) {
  EXPECT_EQ(executor_->underWay(), 0u);
}

}  // namespace
}  // namespace corridor
