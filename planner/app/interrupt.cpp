#include "planner/app/interrupt.h"

#include <csignal>
#include <cstdint>
#include <ctime>

namespace corridor::app {
namespace {

// All that a signal handler can reach.
std::atomic<bool> interruptAsked = false, secondEnds = true;
std::atomic<int> signalTaken = 0;       // the first
std::atomic<std::int64_t> askedAt = 0;  // milliseconds; 0: not yet
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free &&
              std::atomic<std::int64_t>::is_always_lock_free);

/// One interrupt may come twice: timeout(1) sends it to the program, then to its group.
constexpr std::int64_t kSameMs = 500;

void onInterrupt(int signal) {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  const std::int64_t ms = std::int64_t{now.tv_sec} * 1000 + now.tv_nsec / 1'000'000;
  std::int64_t first = 0;
  if (askedAt.compare_exchange_strong(first, ms)) {
    signalTaken = signal;
    interruptAsked = true;
  } else if (secondEnds && ms - first > kSameMs) {  // who asks again wants no more waiting
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
}

}  // namespace

const std::atomic<bool>& listenForInterrupts(SecondInterrupt second) {
  secondEnds = second == SecondInterrupt::ends;
  struct sigaction action {};
  action.sa_handler = onInterrupt;
  action.sa_flags = SA_RESTART;  // who reads a pipe meanwhile, such as a plot's, isn't disturbed
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  struct sigaction hangUp {};
  sigaction(SIGHUP, nullptr, &hangUp);
  if (hangUp.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);
  return interruptAsked;
}

int interruptedStatus() {
  return 128 + signalTaken;
}

}  // namespace corridor::app
