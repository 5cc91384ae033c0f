#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "collision/core/error.h"

namespace corridor {

/// Collects the faults of one robot, which a file or a program describes. Keeps at most
/// `FaultList::kMost` faults.
class RobotFaults {
 public:
  /// @param label the beginning of messages: the file's name, or another name for the robot.
  explicit RobotFaults(std::string label) : label_(std::move(label)) {}

  /// Adds a fault.
  /// @param line the fault's line, counted from 1; 0 if the fault concerns the robot as a whole, or
  /// if there is no file.
  void fault(int line, std::string text);
  /// Formats "label:line: text", for notes.
  std::string at(int line, const std::string& text) const;
  /// Returns whether no fault was reported since the last call of `takeFaults`.
  bool sound() const { return faultCount_ == 0; }
  /// Returns the number of all faults, including those that are not kept because the list is
  /// limited.
  std::size_t faultCount() const { return faultCount_; }
  /// Returns whether to search for similar names, which messages suggest. The search is skipped
  /// after 100 faults, because its time grows with the number of names.
  bool hints() const { return faultCount_ < 100; }
  /// Returns the faults that were kept, sorted by line, and removes all faults. If more faults were
  /// reported than kept, an additional last entry gives the number of the others.
  std::vector<Fault> takeFaults();

 protected:
  void setLabel(std::string label) { label_ = std::move(label); }
  /// Replaces all faults by the given ones.
  void setFaults(const std::vector<Fault>& faults);

 private:
  std::string label_;
  std::vector<Fault> faults_;
  std::size_t faultCount_ = 0;
};

/// Formats kind and name: `joint "elbow"`.
std::string owned(const std::string& kind, std::string_view name);

/// Returns `robot "arm"`, or "robot" for "": a robot that has no name because it is the only one.
std::string robotLabel(std::string_view name);

/// Returns " on line N" for messages, or "" for 0: no file.
std::string onLine(int line);

}  // namespace corridor
