#pragma once

#include <functional>
#include <ostream>
#include <string>
#include <sys/types.h>
#include <vector>

#include "tests/planner/app/program_test.h"

namespace corridor::test {

/// A way in which a command is used: what faults and signals are tried on. A new command, output
/// option or query must appear here (`Uses.HaveEveryCommand…`). All files are written to the folder
/// `out`.
struct Use {
  std::string name;                ///< of its tests
  std::string arguments;           ///< of the program: a command that ends by itself, soon
  std::vector<std::string> files;  ///< that it writes, in `out`; the same bytes each time
  std::string longer = {};         ///< the same so large that a signal comes before its end
  std::string sign = {};           ///< a file that tells that `longer` is well under way
  bool keeps = false;              ///< on a signal it writes what it has, whole
};

const std::vector<Use>& uses();

inline void PrintTo(const Use& use, std::ostream* out) {
  *out << use.arguments;
}

/// The program in a folder with inputs for all uses, and `out`; TMPDIR is another folder.
class UseTest : public ProgramTest, public testing::WithParamInterface<Use> {
 protected:
  UseTest();
  ~UseTest() override;

  /// How a process has ended.
  struct End {
    int status = -1;  ///< as shells count: 128 + N by signal N
    std::string err;
    bool alone = true;  ///< it has left no process
  };
  /// Runs in the child before the program begins.
  using Setup = std::function<void()>;

  /// Starts the program in a process group of its own: stdin is a pipe on which nothing comes,
  /// stdout and stderr are files, unless `setup` does otherwise. @returns its process id.
  pid_t start(const std::string& arguments, const Setup& setup = {});
  /// The same by way of another program: words before the program's own.
  pid_t startBy(const std::vector<std::string>& wrapper, const std::string& arguments,
                const Setup& setup = {});
  End wait(pid_t id);
  End end(const std::string& arguments, const Setup& setup = {}) {
    return wait(start(arguments, setup));
  }
  /// The names in `out` and below it, but for folders.
  std::vector<std::string> written() const;
  /// No file of another name than the use's, or of one that is not whole; nothing in TMPDIR.
  void expectWholeOrNothing(const Use& use) const;
  /// What the use writes where nothing is in its way.
  void learnWhole(const Use& use);
  /// A shell's command that may mount, before words to run there; empty where that is not allowed.
  static std::vector<std::string> mounting(const std::string& script);

  std::map<std::string, std::string> whole_;

 private:
  int input_ = -1;  ///< the end that nobody writes to
};

}  // namespace corridor::test
