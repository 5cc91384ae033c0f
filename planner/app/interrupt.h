#pragma once

#include <atomic>

namespace corridor::app {

/// What a SIGINT does that comes more than half a second after the first.
enum class SecondInterrupt {
  ends,      ///< the program, as always
  isIgnored  ///< for what stops soon, and has to tidy up
};

/// From now on the first SIGINT asks to stop, by the flag returned.
const std::atomic<bool>& listenForInterrupts(SecondInterrupt second = SecondInterrupt::ends);

}  // namespace corridor::app
