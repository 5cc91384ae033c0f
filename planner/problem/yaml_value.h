#pragma once

#include <cstddef>
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

/// Limits of a document: 1.4 GB of memory, and no stack to speak of. There are no aliases, so none
/// can multiply what stands in the file.
struct YamlLimits {
  std::size_t nodes = 10'000'000;  ///< keys and values
  std::size_t depth = 64;          ///< of lists and maps in each other
};

/// Parses one YAML document.
/// @param file for messages.
/// @throws InputError: syntax error, more than one document, aliases, a key that is no word, or
/// beyond the limits.
YamlValue parseYaml(const std::string& file, const std::string& text,
                    const YamlLimits& limits = {});

}  // namespace corridor
