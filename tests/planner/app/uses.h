#pragma once

#include <functional>
#include <ostream>
#include <string>
#include <sys/types.h>
#include <vector>

#include "tests/planner/app/program_test.h"

namespace corridor::test {

/// One use of a command, on which the tests of faults and signals run. Every command, output option
/// and query must have a use (`Uses.HaveEveryCommand…` tests this). All files are written to the
/// folder `out`.
struct Use {
  std::string name;       ///< part of the names of the tests that run this use
  std::string arguments;  ///< arguments of the program, which must soon end without a signal
  /// Files that the program writes to `out`, with the same bytes each time.
  std::vector<std::string> files;
  std::string longer = {};  ///< like `arguments`, but the run takes so long that a signal ends it
  std::string startedFile = {};  ///< a file that exists once `longer` is well under way
  /// After a signal, the program still writes its results so far, as complete files.
  bool keeps = false;
};

const std::vector<Use>& uses();

inline void PrintTo(const Use& use, std::ostream* out) {
  *out << use.arguments;
}

/// Runs the program in a folder with the inputs of all uses and the folder `out`; TMPDIR is the
/// folder `tmp` beside it.
class UseTest : public ProgramTest, public testing::WithParamInterface<Use> {
 protected:
  UseTest();
  ~UseTest() override;

  /// How a process ended.
  struct End {
    int status = -1;  ///< as shells report it: 128 + N after signal N
    std::string err;
    bool noChildLeft = true;
  };
  /// A function that the child process calls before it executes the program.
  using Setup = std::function<void()>;

  /// Starts the program in a process group of its own. Unless `setup` redirects them, stdin is a
  /// pipe that stays empty, and stdout and stderr are files. @returns its process id.
  pid_t start(const std::string& arguments, const Setup& setup = {});
  /// Does the same as `start`, but another program starts the program under test. `wrapper` is that
  /// other program with its arguments.
  pid_t startBy(const std::vector<std::string>& wrapper, const std::string& arguments,
                const Setup& setup = {});
  End wait(pid_t id);
  End end(const std::string& arguments, const Setup& setup = {}) {
    return wait(start(arguments, setup));
  }
  /// Returns the files in `out` and below.
  std::vector<std::string> written() const;
  /// Expects that `out` holds only files that `whole_` has, with the same bytes, and that TMPDIR is
  /// empty. For `benchmark`, whose files contain varying times, only temporary files are refused in
  /// `out`.
  void expectWholeOrNothing(const Use& use) const;
  /// Runs the use without faults, stores the contents of the written files in `whole_`, and empties
  /// `out`.
  void learnWhole(const Use& use);
  /// Returns a command that runs a shell script with the right to mount file systems; empty if
  /// mounting is not allowed here. The caller appends the program and its arguments, which the
  /// script gets as its own arguments.
  static std::vector<std::string> mounting(const std::string& script);

  std::map<std::string, std::string> whole_;

 private:
  int input_ = -1;  ///< the writing end of stdin's pipe; nothing is written to it
};

}  // namespace corridor::test
