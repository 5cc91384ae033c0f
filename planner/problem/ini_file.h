#pragma once

#include <optional>
#include <string>
#include <vector>

#include "collision/core/fault_list.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {

/// An INI file as OMPL.app reads it: `[section]`, `key = value`, `#` begins a comment, blanks
/// around words don't count.
class IniFile {
 public:
  struct Entry {
    std::string key;  ///< "section.key"
    std::string value;
    int line = 0;
  };

  /// Lines that are neither of the above go to `faults`.
  IniFile(std::string file, const std::string& text, FaultList& faults);

  const std::vector<Entry>& entries() const { return entries_; }
  /// The first entry of that name.
  const Entry* find(const std::string& key) const;
  /// Its value as a number; faults one that is none. nullopt: absent or faulted.
  std::optional<double> number(const std::string& key, Range range = Range::Any) const;
  void fault(const Entry& entry, const std::string& text) const;
  void fault(int line, const std::string& text) const { faults_->add(file_, line, text); }

 private:
  std::string file_;
  FaultList* faults_;
  std::vector<Entry> entries_;
};

}  // namespace corridor
