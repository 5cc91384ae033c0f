#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace corridor {

/// A program to run, without a shell.
struct ProgramCall {
  std::vector<std::string> words;             ///< path of the program, then its arguments
  std::filesystem::path folder = {};          ///< working folder; empty: the current folder
  std::vector<std::string> environment = {};  ///< "NAME=value"; empty: that of this process
  double seconds = 60;                        ///< time limit
  /// Limit of each output, bytes. The outputs are kept in memory. Without a limit, a program could
  /// use up the memory.
  std::size_t bytes = std::size_t{1} << 28;
  const std::atomic<bool>* interrupted = nullptr;  ///< stops the program when it becomes true
};

/// How a program ended. If `why` is `timedOut` or `interrupted`, the program was killed. If it is
/// `tooMuchOutput`, the program was killed or had already ended. `statusLost`: the program has
/// ended, but this process ignores SIGCHLD, so nobody knows whether it succeeded. In every case,
/// the processes that remained in the program's process group were killed.
struct ProgramEnd {
  enum class Why { exited, timedOut, interrupted, tooMuchOutput, statusLost };
  Why why = Why::exited;
  int exitStatus = -1;   ///< −1: the program was killed, or ended by a signal
  int signal = 0;        ///< the signal that ended the program by itself; 0: none
  std::string out, err;  ///< standard output and error; empty for `tooMuchOutput`
};

/// Runs a program until it ends, or kills it when a limit of `call` is exceeded or `interrupted`
/// becomes true. The program's standard input is empty. The program runs in a process group of its
/// own, and is killed when the calling thread ends. Several threads may call this function.
/// @throws std::system_error if no process, or no memory file for its output, can be created. If a
/// process was created but can't run the program, the exit status is 127.
ProgramEnd runProgram(const ProgramCall& call);

/// Searches PATH for a program, and returns its absolute path. Returns an empty path if PATH has no
/// program of this name.
std::filesystem::path findProgram(const std::string& name);

}  // namespace corridor
