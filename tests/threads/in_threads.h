#pragma once

#include <algorithm>
#include <array>
#include <barrier>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "collision/core/counters.h"
#include "collision/motion/certify_motion.h"

namespace corridor::test {

constexpr int kThreads = 4;

/// Calls `work(k)` for each k in [0, kThreads), each in its own thread. All calls start at the same
/// moment. Returns when all calls have returned.
template <class Work>
void inThreads(const Work& work) {
  std::barrier start(kThreads);
  std::vector<std::jthread> threads;
  for (int k = 0; k < kThreads; ++k)
    threads.emplace_back([&, k] {
      start.arrive_and_wait();
      work(k);
    });
}

/// The answers of several queries, as a list of bits. Two lists are equal if all answers agree to
/// the last bit.
///
/// Queries of copies of the bodies are compared by their verdicts only (`verdicts`). Their
/// counters, the triangles that they report, and their last digits may differ.
class Answers {
 public:
  void add(std::integral auto value) { bits_.push_back(static_cast<std::uint64_t>(value)); }
  void add(double value) { bits_.push_back(std::bit_cast<std::uint64_t>(value)); }
  void add(const Vec3& v) {
    for (int i = 0; i < 3; ++i) add(v[i]);
  }
  void addVerdict(auto verdict) {
    add(static_cast<int>(verdict));
    verdicts_.push_back(static_cast<int>(verdict));
  }
  void add(const MotionResult& result) {
    addVerdict(result.verdict);
    add(static_cast<int>(result.reason));
    add(result.certifiedUntil);
    add(result.time);
    add(result.grazing);
    if (result.pair) add(*result.pair);
    add(result.gap);
  }
  void add(const Contact& pair) {
    for (const std::size_t body : {pair.bodyA, pair.bodyB}) add(body);
    for (const std::uint32_t triangle : {pair.primitiveA, pair.primitiveB}) add(triangle);
  }
  void add(const Counters& counters) {
    for (const std::uint64_t count :
         {counters.boxTests, counters.primitiveTests, counters.exactTests, counters.poses,
          counters.splits, counters.edges, counters.states, counters.undecided})
      add(count);
  }

  const std::vector<int>& verdicts() const { return verdicts_; }
  int count(auto verdict) const {
    return static_cast<int>(
        std::count(verdicts_.begin(), verdicts_.end(), static_cast<int>(verdict)));
  }
  bool operator==(const Answers&) const = default;

 private:
  std::vector<std::uint64_t> bits_;
  std::vector<int> verdicts_;  // must agree also on copies of the bodies
};

/// Calls `ask()` in all threads at once, and then in one more thread. Expects the same bits from
/// all of them. All threads are new. @returns the answers of the last thread.
template <class Ask>
Answers expectSameAnswersInAllThreads(const Ask& ask) {
  std::array<Answers, kThreads> answers;
  inThreads([&](int k) { answers[static_cast<std::size_t>(k)] = ask(); });
  Answers alone;
  std::jthread([&] { alone = ask(); }).join();
  for (const Answers& mine : answers) EXPECT_TRUE(mine == alone);
  return alone;
}

}  // namespace corridor::test
