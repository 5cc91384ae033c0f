#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace corridor {

/// One fault in a user's input: the place of the fault, what is wrong, and what would be right.
struct Fault {
  std::string file;  ///< as the user named it; empty: not in a file, for example in an option
  int line = 0;      ///< counted from 1; 0: the file as a whole
  std::string text;

  /// Returns "file:line: text". Without a line: "file: text". Without a file: "line 3: text", or
  /// only the text.
  std::string str() const;
  bool operator==(const Fault&) const = default;
};

/// The exception for bad input. It carries all faults found; `what()` lists them one per line. In
/// `faults()` and `what()`, control characters in the texts and file names of the faults are
/// replaced by '?'. A command of Corridor that gets this exception ends with exit status 2.
class InputError : public std::runtime_error {
 public:
  explicit InputError(std::vector<Fault> faults);
  explicit InputError(Fault fault) : InputError(std::vector<Fault>{std::move(fault)}) {}

  const std::vector<Fault>& faults() const { return faults_; }

 private:
  std::vector<Fault> faults_;
};

}  // namespace corridor
