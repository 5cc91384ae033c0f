#include "planner/import/ini_file.h"

#include <algorithm>
#include <sstream>
#include <string_view>

#include "collision/core/spelling.h"

namespace corridor {
namespace {

std::string trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == text.npos) return "";
  return std::string(text.substr(first, text.find_last_not_of(" \t\r") - first + 1));
}

}  // namespace

IniFile::IniFile(std::string file, const std::string& text, FaultList& faults)
    : file_(std::move(file)), faults_(&faults) {
  std::istringstream stream(text);
  std::string section, raw;
  for (int line = 1; std::getline(stream, raw); ++line) {
    const std::string content = trimmed(std::string_view(raw).substr(0, raw.find('#')));
    if (content.empty()) continue;
    if (content.front() == '[' && content.back() == ']') {
      section = trimmed(std::string_view(content).substr(1, content.size() - 2)) + ".";
      continue;
    }
    const auto equals = content.find('=');
    const std::string key = trimmed(std::string_view(content).substr(0, equals));
    if (equals == content.npos || key.empty()) {
      fault(line, "[section] or key = value is needed, not " + quotedWord(content));
      continue;
    }
    entries_.push_back(
        {section + key, trimmed(std::string_view(content).substr(equals + 1)), line});
  }
}

const IniFile::Entry* IniFile::find(const std::string& key) const {
  const auto found =
      std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.key == key; });
  return found == entries_.end() ? nullptr : &*found;
}

void IniFile::fault(const Entry& entry, const std::string& text) const {
  const auto dot = entry.key.find('.');
  fault(entry.line, entry.key.substr(dot == entry.key.npos ? 0 : dot + 1) + ": " + text);
}

std::optional<double> IniFile::number(const std::string& key, Range range) const {
  const Entry* entry = find(key);
  return entry ? number(*entry, range) : std::nullopt;
}

std::optional<double> IniFile::number(const Entry& entry, Range range) const {
  double value = 0;
  const std::string complaint = parseNumber(entry.value, range, value);
  if (complaint.empty()) return value;
  fault(entry, complaint);
  return std::nullopt;
}

}  // namespace corridor
