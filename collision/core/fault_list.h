#pragma once

#include <string>
#include <utility>
#include <vector>

#include "collision/core/error.h"

namespace corridor {

/// Collects the faults of an input and of the files that it names, so that its user sees all of
/// them at once. At the thousandth it gives up: `add` throws all of them.
class FaultList {
 public:
  static constexpr std::size_t kMost = 1000;

  /// @param mainFile whose faults come first; empty: no file does.
  explicit FaultList(std::string mainFile = {}) : mainFile_(std::move(mainFile)) {}
  void add(std::string file, int line, std::string text);
  void add(const InputError& error);
  /// Does something that may throw an InputError, and keeps its faults instead.
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

  /// @throws InputError with all faults, if there are any: the main file's first, then those of
  /// others in the order in which they came up, each by line.
  void throwIfAny() const;

 private:
  void throwIfFull() const;

  std::string mainFile_;
  std::vector<Fault> faults_;
};

}  // namespace corridor
