#include "collision/core/error.h"

#include <utility>

namespace corridor {
namespace {

/// Replaces control characters in file names and texts by '?'. They may come from a damaged file,
/// which may also name another file. After the replacement each fault is one line, and no text from
/// a file can send commands to the terminal.
std::vector<Fault> printableFaults(std::vector<Fault> faults) {
  for (Fault& fault : faults)
    for (std::string* text : {&fault.file, &fault.text})
      for (char& c : *text)
        if ((c >= 0 && c < ' ') || c == 0x7f) c = '?';
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
