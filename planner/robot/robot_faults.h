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
  /// Returns the text of a note: "label:line: text", or "label: text" if the line is 0.
  std::string at(int line, const std::string& text) const;
  /// Returns whether no fault was reported since the last call of `takeFaults`.
  bool sound() const { return faultCount_ == 0; }
  /// Returns the number of all faults, including those that are not kept because the list is
  /// limited.
  std::size_t faultCount() const { return faultCount_; }
  /// Returns whether messages should suggest similar names. After 100 faults they should not,
  /// because the time to search for similar names grows with the number of names.
  bool hints() const { return faultCount_ < 100; }
  /// Returns the faults that were kept, sorted by line, and removes all faults. If more faults were
  /// reported than were kept, an additional last entry gives the number of faults that were not
  /// kept.
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

/// Returns " on line N" for messages, or "" for line 0, which means that there is no line.
std::string onLine(int line);

}  // namespace corridor
