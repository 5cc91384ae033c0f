#include "planner/problem/format_key.h"

#include <algorithm>

namespace corridor {

bool acceptsFormat(const YamlValue& document, const std::string& format, YamlSource& source) {
  if (document.kind != YamlValue::Kind::Map) {
    source.fault(document.line, "a map (key: value) that begins with \"format: " + format +
                                    "\" is needed, not " + described(document));
    return false;
  }
  const auto entry = std::find_if(document.entries.begin(), document.entries.end(),
                                  [](const auto& e) { return e.key == "format"; });
  if (entry == document.entries.end()) {
    source.fault(0, "missing key \"format\"; begin the file with format: " + format);
    return true;
  }
  entry->use = YamlValue::Entry::Use::read;
  if (entry->value.text == format) return true;
  source.fault(entry->line,
               "format: " + format + " is needed here, not " + described(entry->value));
  return false;
}

std::string nameOfFile(const std::filesystem::path& file, const std::string& usual) {
  if (file.stem() != usual) return file.stem().string();
  const auto folder = std::filesystem::absolute(file).lexically_normal().parent_path().filename();
  return folder.empty() ? usual : folder.string();
}

}  // namespace corridor
