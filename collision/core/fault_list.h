#pragma once

#include <string>
#include <utility>
#include <vector>

#include "collision/core/error.h"

namespace corridor {

/// Collects the faults of an input and of the files that it names, so that the user sees all of
/// them at once. At the thousandth fault `add` throws all of them.
class FaultList {
 public:
  static constexpr std::size_t kMost = 1000;

  /// @param mainFile  its faults are listed first; empty: no file is preferred.
  explicit FaultList(std::string mainFile = {}) : mainFile_(std::move(mainFile)) {}
  void add(std::string file, int line, std::string text);
  void add(const InputError& error);
  /// Calls `step`; if it throws an InputError, keeps the faults instead.
  template <class Step>
  void collect(const Step& step) {
    try {
      step();
    } catch (const InputError& error) {
      if (size() >= kMost) throw;
      add(error);
    }
  }

  std::size_t size() const { return faults_.size(); }

  /// @throws InputError with all faults, if there are any: first the main file's, then those of the
  /// other files in the order of their first faults; within a file by line.
  void throwIfAny() const;

 private:
  void throwIfFull() const;

  std::string mainFile_;
  std::vector<Fault> faults_;
};

}  // namespace corridor
