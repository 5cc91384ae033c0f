#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "collision/core/fault_list.h"

namespace corridor {

/// The faults of the rows of a file. Many rows often have the same fault, so only the faults of the
/// first faulty row are kept. The text of the last of these faults says how many more rows have
/// faults.
class RowFaults {
 public:
  explicit RowFaults(std::string file) : file_(std::move(file)) {}

  /// Calls `read` with a list for the faults of one row. Returns whether the row has no faults.
  template <class Read>
  bool row(const Read& read) {
    FaultList faults(file_);
    try {
      read(faults);
      faults.throwIfAny();
      return true;
    } catch (const InputError& error) {
      if (++count_ == 1) first_ = error.faults();
      return false;
    }
  }
  void addTo(FaultList& faults) const {
    std::vector<Fault> all = first_;
    if (count_ > 1)
      all.back().text += count_ == 2
                             ? " (1 more row has faults)"
                             : " (" + std::to_string(count_ - 1) + " more rows have faults)";
    faults.add(all);
  }

 private:
  std::string file_;
  std::vector<Fault> first_;
  std::size_t count_ = 0;  ///< rows with faults
};

}  // namespace corridor
