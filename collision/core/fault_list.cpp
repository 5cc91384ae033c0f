#include "collision/core/fault_list.h"

#include <algorithm>

namespace corridor {

void FaultList::add(std::string file, int line, std::string text) {
  faults_.push_back({std::move(file), line, std::move(text)});
  throwIfFull();
}

void FaultList::add(const std::vector<Fault>& faults) {
  faults_.insert(faults_.end(), faults.begin(), faults.end());
  throwIfFull();
}

void FaultList::throwIfAny() const {
  if (faults_.empty()) return;
  std::vector<std::string> files{mainFile_};
  for (const Fault& fault : faults_)
    if (std::find(files.begin(), files.end(), fault.file) == files.end())
      files.push_back(fault.file);
  const auto rank = [&](const Fault& fault) {
    return std::find(files.begin(), files.end(), fault.file) - files.begin();
  };
  std::vector<Fault> sorted;
  for (const Fault& fault : faults_)
    if (std::find(sorted.begin(), sorted.end(), fault) == sorted.end()) sorted.push_back(fault);
  std::stable_sort(sorted.begin(), sorted.end(), [&](const Fault& a, const Fault& b) {
    return rank(a) != rank(b) ? rank(a) < rank(b) : a.line < b.line;
  });
  if (isFull())
    sorted.push_back(
        {mainFile_, 0,
         "reading stopped at " + std::to_string(size()) + " faults; there may be more"});
  throw InputError(std::move(sorted));
}

}  // namespace corridor
