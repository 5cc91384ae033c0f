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

  /// Parses `text`. Adds a fault to `faults` for each line that has neither form. `faults` must
  /// outlive the object.
  IniFile(std::string file, const std::string& text, FaultList& faults);

  const std::vector<Entry>& entries() const { return entries_; }
  /// Returns the first entry with this key ("section.key"), or nullptr.
  const Entry* find(const std::string& key) const;
  /// Returns the value of this key as a number. Returns nullopt if the key is absent, or if a fault
  /// was added.
  std::optional<double> number(const std::string& key, Range range = Range::Any) const;
  /// Returns the value of `entry` as a number, or nullopt if a fault was added.
  std::optional<double> number(const Entry& entry, Range range) const;
  void fault(const Entry& entry, const std::string& text) const;
  void fault(int line, const std::string& text) const { faults_->add(file_, line, text); }

 private:
  std::string file_;
  FaultList* faults_;
  std::vector<Entry> entries_;
};

}  // namespace corridor
