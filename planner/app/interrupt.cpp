#include "planner/app/interrupt.h"

#include <csignal>

namespace corridor::app {
namespace {

// The one thing that a signal handler can reach.
std::atomic<bool> interruptAsked = false;
static_assert(std::atomic<bool>::is_always_lock_free);

}  // namespace

const std::atomic<bool>& listenForInterrupts() {
  struct sigaction action {};
  action.sa_handler = [](int) { interruptAsked = true; };
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  return interruptAsked;
}

}  // namespace corridor::app
