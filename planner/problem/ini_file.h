#pragma once

#include <optional>
#include <string>
#include <vector>

#include "collision/core/fault_list.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {

/// An INI file as OMPL.app reads it: lines `[section]` and `key = value`. `#` begins a comment;
/// blanks around words are ignored.
class IniFile {
 public:
  struct Entry {
    std::string key;  ///< "section.key"
    std::string value;
    int line = 0;
  };

  /// Adds a fault to `faults` for each line of another form. `faults` must outlive the object.
  IniFile(std::string file, const std::string& text, FaultList& faults);

  const std::vector<Entry>& entries() const { return entries_; }
  /// Returns the first entry with that key ("section.key"), or nullptr.
  const Entry* find(const std::string& key) const;
  /// Returns the value of that key as a number, or nullopt if it is absent or faulted.
  std::optional<double> number(const std::string& key, Range range = Range::Any) const;
  void fault(const Entry& entry, const std::string& text) const;
  void fault(int line, const std::string& text) const { faults_->add(file_, line, text); }

 private:
  std::string file_;
  FaultList* faults_;
  std::vector<Entry> entries_;
};

}  // namespace corridor
