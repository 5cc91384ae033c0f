#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace corridor {

/// A value of a YAML document: a scalar, or a list or map with all values in it. Repeated keys are
/// kept. Each value and each key has the number of its line in the file; the first line is 1.
///
/// A document is also the ledger of its reader: `YamlMap` marks the maps and the keys that were
/// read, and `unreadKeys` (yaml_ledger.h) returns the others. One thread reads a document.
struct YamlValue {
  enum class Kind { Null, Scalar, List, Map };
  struct Entry;

  Kind kind = Kind::Null;
  int line = 0;
  std::string text;        ///< Scalar
  bool isPlain = false;    ///< Scalar: written without quotes, so it may be a number or true, false
  bool inDegrees = false;  ///< Scalar: tagged !degrees (`YamlLimits::angleTags`)
  std::vector<YamlValue> items;   ///< List
  std::vector<Entry> entries;     ///< Map
  mutable bool isOpened = false;  ///< Map: a YamlMap was made of it
};

struct YamlValue::Entry {
  /// What the reader of the file did with the key.
  enum class Use {
    unread,  ///< nothing
    read,    ///< it used the value, or added a fault
    ignored  ///< it does not need the value: nothing depends on it
  };

  std::string key;
  int line = 0;
  YamlValue value;
  mutable Use use = Use::unread;
};

/// Limits of a document. They keep its memory, besides its texts, below 2 GB, and its nesting
/// small. Aliases are errors, because nested aliases can expand a small file without bound.
struct YamlLimits {
  std::size_t nodes = 10'000'000;  ///< keys and values
  std::size_t depth = 64;          ///< the largest depth of nested lists and maps
  bool angleTags = false;  ///< whether scalars may have the tags !degrees and !radians of ROS
};

/// Parses one YAML document. Empty ones may follow it: `rostopic echo` ends each message by `---`.
/// @param file for messages.
/// @throws InputError for a syntax error, more than one document, an alias, a tag (except those
/// that only repeat the value's form, such as !!str, !!float, !!seq and !!map, and Python's
/// tuples), a key that is no word, or a document beyond the limits.
YamlValue parseYaml(const std::string& file, const std::string& text,
                    const YamlLimits& limits = {});

}  // namespace corridor
