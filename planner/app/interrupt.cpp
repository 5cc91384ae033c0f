#include "planner/app/interrupt.h"

#include <csignal>
#include <cstdint>
#include <ctime>

#include "collision/core/user_signals.h"

namespace corridor::app {
namespace {

// Globals, because a signal handler gets no argument except the signal's number.
std::atomic<bool> interruptAsked = false, secondEnds = true;
std::atomic<int> signalTaken = 0;       // number of the first signal
std::atomic<std::int64_t> askedAt = 0;  // time of the first signal, milliseconds; 0: none yet
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free &&
              std::atomic<std::int64_t>::is_always_lock_free);

/// Milliseconds within which a second signal counts as the same interrupt. timeout(1) sends its
/// signal twice: to the program, and then to its process group.
constexpr std::int64_t kSameMs = 500;

void onInterrupt(int signal) {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  const std::int64_t ms = std::int64_t{now.tv_sec} * 1000 + now.tv_nsec / 1'000'000;
  std::int64_t first = 0;
  if (askedAt.compare_exchange_strong(first, ms)) {
    signalTaken = signal;
    interruptAsked = true;
  } else if (secondEnds && ms - first > kSameMs && signal != SIGUSR1) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
}

}  // namespace

const std::atomic<bool>& listenForInterrupts(SecondInterrupt second) {
  secondEnds = second == SecondInterrupt::ends;
  struct sigaction action {};
  action.sa_handler = onInterrupt;
  action.sa_flags = SA_RESTART;  // a signal doesn't end the reading of a pipe
  for (const int signal : kUserSignals) {
    struct sigaction before {};
    sigaction(signal, nullptr, &before);
    if (signal != SIGHUP || before.sa_handler != SIG_IGN) sigaction(signal, &action, nullptr);
  }
  return interruptAsked;
}

int interruptedStatus() {
  return 128 + signalTaken;
}

}  // namespace corridor::app
