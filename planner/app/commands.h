#pragma once

namespace CLI {
class App;
}

/// The commands of the program. Each is a file NAME_command.cpp, which declares its options and
/// their help, checks which of them can be combined, and does the work.
namespace corridor::app {

/// Exit statuses of all commands, documented by --help and in the README. A command that a signal N
/// stopped ends with 128 + N instead (`interruptedStatus`).
enum Exit { kDone = 0, kNegativeResult = 1, kBadInput = 2, kInternal = 3 };

/// Adds a command to the program. If the command is on the command line, `program.parse` runs it,
/// and sets `status` to its exit status. `program.parse` throws InputError for bad input, or for a
/// result that can't be written. @pre `status` outlives the call of `program.parse`.
void addSolve(CLI::App& program, int& status);
void addVerify(CLI::App& program, int& status);
void addView(CLI::App& program, int& status);
void addBenchmark(CLI::App& program, int& status);  ///< of the program corridor_benchmark
void addCheck(CLI::App& program, int& status);
void addInspect(CLI::App& program, int& status);
void addPose(CLI::App& program, int& status);
void addCache(CLI::App& program, int& status);
void addNew(CLI::App& program, int& status);

}  // namespace corridor::app
