#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace corridor {

/// One fault of a user's input: where it is, what is wrong, and what would be right.
struct Fault {
  std::string file;  ///< as the user named it; empty: no file (a command-line option, say)
  int line = 0;      ///< from 1; 0: the file as a whole
  std::string text;

  /// "file:line: text".
  std::string str() const;
};

/// Bad input. Carries all faults that were found, `what()` has them one a line (control characters
/// in their texts become '?'). The program turns it into exit status 2.
class InputError : public std::runtime_error {
 public:
  explicit InputError(std::vector<Fault> faults);
  explicit InputError(Fault fault) : InputError(std::vector<Fault>{std::move(fault)}) {}

  const std::vector<Fault>& faults() const { return faults_; }

 private:
  std::vector<Fault> faults_;
};

}  // namespace corridor
