#pragma once

#include <atomic>

namespace corridor::app {

/// From now on the first SIGINT asks to stop, by the flag returned; another one, more than half a
/// second later, ends the program as always.
const std::atomic<bool>& listenForInterrupts();

}  // namespace corridor::app
