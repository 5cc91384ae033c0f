#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "collision/core/error.h"

namespace corridor {

/// Collects the faults of an input and of the files that it names, so that its user sees all of
/// them at once.
class FaultList {
 public:
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
      add(error);
    }
  }

  std::size_t size() const { return faults_.size(); }

  /// @throws InputError with all faults, if there are any: the main file's first, then those of
  /// others in the order in which they came up, each by line.
  void throwIfAny() const;

 private:
  std::string mainFile_;
  std::vector<Fault> faults_;
};

/// The bytes of a text file. @param what "a problem", for the message.
/// @throws InputError: no such file, a folder, unreadable, empty.
std::string readTextFile(const std::filesystem::path& file, const std::string& what);

/// The same, and of pipes; "-" is the standard input.
std::string readTextStream(const std::filesystem::path& file, const std::string& what);

/// What keeps a path from being an ordinary file ("no such file …"), or "".
std::string whyNoFile(const std::filesystem::path& file);

}  // namespace corridor
