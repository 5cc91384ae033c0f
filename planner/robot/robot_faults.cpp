#include "planner/robot/robot_faults.h"

#include <algorithm>
#include <utility>

#include "collision/core/fault_list.h"
#include "collision/core/spelling.h"

namespace corridor {

std::string owned(const std::string& kind, std::string_view name) {
  return kind + " " + quotedWord(name);
}

std::string robotLabel(std::string_view name) {
  return name.empty() ? "robot" : owned("robot", name);
}

std::string onLine(int line) {
  return line > 0 ? " on line " + std::to_string(line) : "";
}

void RobotFaults::fault(int line, std::string text) {
  if (++faultCount_ <= FaultList::kMost)
    faults_.push_back({label_, line, withoutControls(std::move(text))});
}

std::string RobotFaults::at(int line, const std::string& text) const {
  return label_ + (line > 0 ? ":" + std::to_string(line) : "") + ": " + text;
}

std::vector<Fault> RobotFaults::takeFaults() {
  std::stable_sort(faults_.begin(), faults_.end(),
                   [](const Fault& a, const Fault& b) { return a.line < b.line; });
  if (faultCount_ > faults_.size())
    faults_.push_back(
        {label_, 0, "and " + std::to_string(faultCount_ - faults_.size()) + " more faults"});
  faultCount_ = 0;
  return std::exchange(faults_, {});
}

void RobotFaults::setFaults(const std::vector<Fault>& faults) {
  faults_ = faults;
  faultCount_ = faults.size();
}

}  // namespace corridor
