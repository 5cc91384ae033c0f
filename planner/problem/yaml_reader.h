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
#include "collision/core/spelling.h"
#include "planner/problem/number_text.h"
#include "planner/problem/yaml_value.h"
#include "planner/robot/note.h"

/// A strict reader of YAML files. The reader adds every fault, with its line, to a list and reads
/// on, so that a user sees all faults at once.
namespace corridor {

class FileCache;

/// A key that is not supported.
struct UnsupportedKey {
  std::string key;
  std::string instead;  ///< what to do instead, as the end of the fault's message
};

/// The keys of a map: the legal ones, and unsupported ones. The fault of an unsupported key says
/// what to do instead.
struct MapKeys {
  std::vector<std::string> legal;
  std::vector<UnsupportedKey> unsupported;
};

/// A file while it is read: the list of its faults, and the lines of its keys.
struct YamlSource {
  std::string file;
  FaultList& faults;
  /// The line of every legal key that was read, by its path ("checker.edges").
  std::map<std::string, int> lines;
  std::vector<Note> notes = {};  ///< notes on values; the file's reader adds them to its own notes
  /// Where keys belong that people write into a wrong map, by the wrong path: the key `time` at the
  /// top level has the text "planner: {time: …}". Faults of unknown keys quote these texts.
  std::map<std::string, std::string> places = {};
  FileCache* cache = nullptr;  ///< see `readProblem`

  void fault(int line, std::string text) const { faults.add(file, line, std::move(text)); }
};

/// The whole numbers that are legal as the value of a key, both ends included.
struct WholeRange {
  std::uint64_t least = 0, most = std::numeric_limits<std::uint64_t>::max();
  const char* words = "0 to 2^64 - 1";  ///< text of the range in messages
};

/// A map of a YAML file, and the path of the map in the file. Functions that return values mark
/// their keys as read (yaml_ledger.h).
class YamlMap {
 public:
  /// Adds a fault if the value is not a map, and a fault for each unknown, unsupported or repeated
  /// key. If a key is repeated, its first value is used. `value` and `source` must outlive the
  /// object.
  /// @param path the path of the map in its file: "", "planner", "planner.params".
  /// @param keys the legal keys; nullptr: any key is legal.
  /// @param example for the fault of a value that is no map, such as "{joints: 0.001}"; if empty,
  /// the first legal key is the example.
  YamlMap(const YamlValue& value, std::string path, const MapKeys* keys, YamlSource& source,
          std::string_view example = {});

  /// Returns the legal entries, and marks all of them as read.
  const std::vector<const YamlValue::Entry*>& entries() const;
  bool empty() const { return entries_.empty(); }  ///< whether there is no legal entry
  /// Marks keys whose values have no effect on anything that Corridor computes. Absent keys are
  /// skipped.
  void ignore(std::initializer_list<std::string_view> keys) const;
  YamlSource& source() const { return *source_; }
  int line() const { return line_; }
  std::string pathOf(std::string_view key) const;
  /// Adds the fault "path: text" at the key's line, or at the map's if the key is absent.
  void fault(std::string_view key, const std::string& text) const;

  const YamlValue* find(std::string_view key) const;  ///< nullptr: absent
  /// Returns the value of the key, or nullptr if the key is absent. If the key is absent, adds a
  /// fault, unless an earlier fault explains the absence: the object was made from a value that is
  /// not a map, or the map has an unsupported key, or an unknown key similar to `key`.
  /// @param purpose a description of the value that the key should have, for the message.
  const YamlValue* require(std::string_view key, const std::string& purpose) const;

  /// Returns the key of `keys` that is present, if exactly one is. Otherwise returns nullopt. If
  /// several keys are present, adds a fault. If none is present, adds a fault unless an earlier
  /// fault explains this (see `require`).
  /// @param what a description of the keys for messages: "one shape".
  std::optional<std::string> requireOne(const std::vector<std::string>& keys,
                                        const std::string& what, const std::string& purpose) const;

  // Each of the following functions returns nullopt if the key is absent. If the value is of the
  // wrong kind, the function adds a fault and returns nullopt.
  std::optional<double> number(std::string_view key, Range range = Range::Any) const;
  /// As `number`, also in quotes, as other programs write numbers.
  std::optional<double> quotableNumber(std::string_view key, Range range = Range::Any) const;
  std::optional<std::uint64_t> wholeNumber(std::string_view key,
                                           const WholeRange& range = {}) const;
  std::optional<bool> boolean(std::string_view key) const;
  /// As `boolean`, also as programs of Python and ROS write it: True, FALSE.
  std::optional<bool> flag(std::string_view key) const;
  std::optional<std::string> text(std::string_view key) const;
  /// Returns the text, or "" if the key is absent or its value is empty, as in messages of ROS,
  /// which have all fields. Also returns "" if a fault was added.
  std::string textOrNone(std::string_view key) const;
  std::optional<std::string> choice(std::string_view key, const std::vector<std::string>& of) const;
  /// Returns a list of exactly `count` numbers.
  std::optional<std::vector<double>> numbers(std::string_view key, std::size_t count) const;
  /// Returns an angle in radians. The map contains this angle in radians as `key`, or in degrees as
  /// `key_deg`.
  std::optional<double> angle(const std::string& key, Range range = Range::Any) const;

 private:
  std::string path_;
  YamlSource* source_;
  int line_ = 0;
  const YamlValue::Entry* entryOf(std::string_view key) const;  ///< nullptr: absent

  std::vector<const YamlValue::Entry*> entries_;
  std::unordered_map<std::string_view, const YamlValue::Entry*> index_;  ///< `entries_` by key
  std::set<std::string> missed_;  ///< legal keys that an unknown key resembles
  bool explainsMissing_ = false;  ///< the value is not a map, or has an unsupported key
};

/// Returns a number, or nullopt if a fault was added. @param path for messages.
std::optional<double> readNumber(const YamlValue& value, Range range, const std::string& path,
                                 const YamlSource& source);

/// Returns the words of a list, or nullopt if a fault was added.
/// @param form an example for the message: "such as [arm, hand]".
std::optional<std::vector<std::string>> readWords(const YamlValue& value, const std::string& form,
                                                  const std::string& path,
                                                  const YamlSource& source);

/// Returns the `count` numbers of a list, or nullopt if a fault was added. @param path for
/// messages.
std::optional<std::vector<double>> readNumbers(const YamlValue& value, std::size_t count,
                                               const std::string& path, const YamlSource& source);

/// Returns whether the value is a map with this key. Does not mark the key as read.
bool hasKey(const YamlValue& value, std::string_view key);

/// Returns whether a key is absent, or its value is an empty list, map or text.
bool isEmpty(const YamlMap& map, std::string_view key);

/// Returns the items of a list. If the key is absent or has no value, the result is empty. Adds a
/// fault for a value of another kind.
std::vector<const YamlValue*> itemsOf(const YamlMap& map, std::string_view key);

/// Reads numbers from a list, or from a map by their names: [1, 2, 3] or {x: 1, y: 2, z: 3}.
/// Returns nullopt if the key is absent, or if a fault was added.
std::optional<std::vector<double>> readNamed(const YamlMap& map, const char* key,
                                             const std::vector<std::string>& names);

/// Returns a value's description for messages: `"text"`, `a list`, `a map` or `nothing`.
std::string described(const YamlValue& value);

}  // namespace corridor
