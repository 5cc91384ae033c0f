#pragma once

#include <cstdint>
#include <initializer_list>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "collision/core/fault_list.h"
#include "planner/problem/yaml_value.h"

/// A strict reader of YAML files: every fault is noted with its line, and reading goes on, so that
/// a user sees all at once.
namespace corridor {

/// A key that a later version will read.
struct LaterKey {
  std::string key;
  std::string instead;  ///< what is supported: the end of a sentence
};

/// What a map may hold.
struct MapKeys {
  std::vector<std::string> legal;
  std::vector<LaterKey> later;
};

/// A file being read: where faults go, and where its keys stand.
struct YamlSource {
  std::string file;
  FaultList& faults;
  std::map<std::string, int> lines;  ///< "checker.edges" → line, of every legal key that was met

  void fault(int line, std::string text) const { faults.add(file, line, std::move(text)); }
};

/// What numbers a key takes.
enum class Range { Any, NotNegative, Positive, Fraction /**< above 0 and under 1 */ };

/// What whole numbers a key takes, both ends included.
struct WholeRange {
  std::uint64_t least = 0, most = std::numeric_limits<std::uint64_t>::max();
  const char* words = "0 to 2^64 - 1";  ///< for the message
};

/// A whole text as a decimal number. @returns a complaint ("a number is needed, not …"), or "" and
/// `value` set. Numbers too small for a double become the nearest, those too large (and nan, inf)
/// are not finite.
std::string parseNumber(std::string_view text, Range range, double& value);

/// One map of a file.
class YamlMap {
 public:
  /// Faults what is no map, and unknown, unsupported and repeated keys. The first of repeated keys
  /// counts.
  /// @param path of the map in its file: "", "planner", "planner.params".
  /// @param keys nullptr: any key is legal.
  YamlMap(const YamlValue& value, std::string path, const MapKeys* keys, YamlSource& source);

  const std::vector<const YamlValue::Entry*>& entries() const { return entries_; }
  YamlSource& source() const { return *source_; }
  int line() const { return line_; }
  std::string pathOf(std::string_view key) const;
  void fault(std::string_view key,
             const std::string& text) const;  ///< at that key's line: "path: text"

  const YamlValue* find(std::string_view key) const;  ///< nullptr: not there
  /// As `find`; faults a key that is not there, unless the map's own faults say so already.
  /// @param purpose what it should hold, for the message.
  const YamlValue* require(std::string_view key, const std::string& purpose) const;

  /// Which one of `keys` is there; faults several, and (as `require`) none.
  /// @param what they say: "one shape", for the message of several.
  std::optional<std::string> requireOne(const std::vector<std::string>& keys,
                                        const std::string& what, const std::string& purpose) const;

  // Each faults a value of the wrong kind. nullopt: absent or faulted.
  std::optional<double> number(std::string_view key, Range range = Range::Any) const;
  std::optional<std::uint64_t> wholeNumber(std::string_view key,
                                           const WholeRange& range = {}) const;
  std::optional<bool> boolean(std::string_view key) const;
  std::optional<std::string> text(std::string_view key) const;
  std::optional<std::string> choice(std::string_view key, const std::vector<std::string>& of) const;
  /// A list of exactly `count` numbers.
  std::optional<std::vector<double>> numbers(std::string_view key, std::size_t count) const;
  /// An angle in radians, given as `key` or as `key_deg`.
  std::optional<double> angle(const std::string& key, Range range = Range::Any) const;

 private:
  std::string path_;
  YamlSource* source_;
  int line_ = 0;
  const YamlValue::Entry* entryOf(std::string_view key) const;  ///< nullptr: not there

  std::vector<const YamlValue::Entry*> entries_;
  std::unordered_map<std::string_view, const YamlValue::Entry*> index_;  ///< the same, by key
  std::set<std::string> missed_;  ///< legal keys that an unknown one may have meant
  bool explainsMissing_ = false;  ///< no map, or it has a key of a later version
};

/// A number. @param path for messages. nullopt: faulted.
std::optional<double> readNumber(const YamlValue& value, Range range, const std::string& path,
                                 const YamlSource& source);

/// A list of words. @param form for the message: "[arm, hand]". nullopt: faulted.
std::optional<std::vector<std::string>> readWords(const YamlValue& value, const std::string& form,
                                                  const std::string& path,
                                                  const YamlSource& source);

/// A list of `count` numbers. @param path for messages.
std::optional<std::vector<double>> readNumbers(const YamlValue& value, std::size_t count,
                                               const std::string& path, const YamlSource& source);

/// For messages: `"text"`, `a list`, `a map`, `nothing`.
std::string described(const YamlValue& value);

/// For messages and notes: the shortest digits that read back as this number.
std::string shortest(double value);

}  // namespace corridor
