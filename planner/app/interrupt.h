#pragma once

#include <atomic>

namespace corridor::app {

/// What a second signal does, if it comes more than half a second after the first.
enum class SecondInterrupt {
  ends,      ///< it ends the program at once, unless it is SIGUSR1, which job scripts send again
  isIgnored  ///< nothing; for work that must remove files, and that ends soon after the first
             ///< signal
};

/// Installs signal handlers and returns the flag that the first signal among `kUserSignals` sets.
/// The caller must poll the flag, and stop when it is set. SIGHUP stays ignored if it was ignored
/// before, as under nohup.
const std::atomic<bool>& listenForInterrupts(SecondInterrupt second = SecondInterrupt::ends);

/// Returns the exit status of a program that the first signal N stopped: 128 + N, as shells report
/// it (130 for SIGINT, 143 for SIGTERM). @pre the flag of `listenForInterrupts` is set.
int interruptedStatus();

}  // namespace corridor::app
