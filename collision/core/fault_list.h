#pragma once

#include <string>
#include <utility>
#include <vector>

#include "collision/core/error.h"

namespace corridor {

/// Collects the faults of an input and of the files that the input names, so that the user sees all
/// faults at once. When the list is full, `add` throws all faults (`throwIfAny`).
class FaultList {
 public:
  static constexpr std::size_t kMost = 1000;

  /// @param mainFile the file whose faults are listed first; empty: no file is preferred.
  /// @param most  the number of faults at which `add` throws.
  explicit FaultList(std::string mainFile = {}, std::size_t most = kMost)
      : mainFile_(std::move(mainFile)), most_(most) {}
  void add(std::string file, int line, std::string text);
  void add(const std::vector<Fault>& faults);
  void add(const InputError& error) { add(error.faults()); }
  /// Calls `step`. If `step` throws an InputError, adds the error's faults to the list. The
  /// exception is a full list: then the error came from `add`, its faults are already in the list,
  /// and `collect` rethrows the error.
  template <class Step>
  void collect(const Step& step) {
    try {
      step();
    } catch (const InputError& error) {
      if (isFull()) throw;
      add(error);
    }
  }

  std::size_t size() const { return faults_.size(); }

  /// @throws InputError with all distinct faults, if there are any. The faults of the main file
  /// come first. The other files follow in the order of their first faults. The faults of one file
  /// are sorted by line. If the list is full, an additional fault at the end reports that reading
  /// stopped. (Equal faults arise if a file is read twice, with different options.)
  void throwIfAny() const;

 private:
  bool isFull() const { return size() >= most_; }
  void throwIfFull() const {
    if (isFull()) throwIfAny();
  }

  std::string mainFile_;
  std::size_t most_;
  std::vector<Fault> faults_;
};

}  // namespace corridor
