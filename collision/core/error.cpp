#include "collision/core/error.h"

#include <utility>

#include "collision/core/spelling.h"

namespace corridor {
namespace {

std::vector<Fault> printableFaults(std::vector<Fault> faults) {
  for (Fault& fault : faults)
    for (std::string* text : {&fault.file, &fault.text}) *text = withoutControls(std::move(*text));
  return faults;
}

std::string faultsText(const std::vector<Fault>& faults) {
  std::string text;
  for (const Fault& fault : faults) {
    if (!text.empty()) text += '\n';
    text += fault.str();
  }
  return text;
}

}  // namespace

std::string Fault::str() const {
  std::string where = file;
  if (line > 0) where += (where.empty() ? "line " : ":") + std::to_string(line);
  return where.empty() ? text : where + ": " + text;
}

InputError::InputError(std::vector<Fault> faults)
    : std::runtime_error(faultsText(printableFaults(faults))),
      faults_(printableFaults(std::move(faults))) {}

}  // namespace corridor
