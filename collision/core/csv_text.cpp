#include "collision/core/csv_text.h"

namespace corridor {

std::string inDoubleQuotes(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string csvField(const std::string& text) {
  return text.find_first_of(",\"\r\n") == text.npos ? text : inDoubleQuotes(text);
}

}  // namespace corridor
