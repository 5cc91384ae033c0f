#pragma once

#include <atomic>

namespace corridor::app {

/// What a signal does that comes more than half a second after the first.
enum class SecondInterrupt {
  ends,      ///< the program, as always
  isIgnored  ///< for what stops soon, and has to tidy up
};

/// From now on the first SIGINT, SIGTERM or SIGHUP asks to stop, by the flag returned. (SIGHUP
/// stays ignored where it is, as under nohup.)
const std::atomic<bool>& listenForInterrupts(SecondInterrupt second = SecondInterrupt::ends);

/// The exit status of a program that stopped because of that signal, as shells count: 128 and the
/// signal's number, 130 for SIGINT and 143 for SIGTERM. @pre the flag is set.
int interruptedStatus();

}  // namespace corridor::app
