#pragma once

#include <string>
#include <vector>

namespace corridor {

/// A YAML document as it stands in its file: repeated keys are kept, and everything knows its line
/// (from 1).
struct YamlValue {
  enum class Kind { Null, Scalar, List, Map };
  struct Entry;

  Kind kind = Kind::Null;
  int line = 0;
  std::string text;      ///< Scalar
  bool isPlain = false;  ///< Scalar: written without quotes, so it may be a number or true, false
  std::vector<YamlValue> items;  ///< List
  std::vector<Entry> entries;    ///< Map
};

struct YamlValue::Entry {
  std::string key;
  int line = 0;
  YamlValue value;
};

/// Parses one YAML document.
/// @param file for messages.
/// @throws InputError: syntax error, more than one document, aliases, or a key that is no word.
YamlValue parseYaml(const std::string& file, const std::string& text);

}  // namespace corridor
