#include "planner/problem/yaml_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>

#include "collision/core/decimal_number.h"
#include "planner/model/settings.h"
#include "planner/problem/text_words.h"

namespace corridor {

bool hasKey(const YamlValue& value, std::string_view key) {
  return std::any_of(value.entries.begin(), value.entries.end(),
                     [&](const YamlValue::Entry& entry) { return entry.key == key; });
}

bool isEmpty(const YamlMap& map, std::string_view key) {
  const YamlValue* const value = map.find(key);
  return !value || (value->items.empty() && value->entries.empty() && value->text.empty());
}

std::vector<const YamlValue*> itemsOf(const YamlMap& map, std::string_view key) {
  std::vector<const YamlValue*> items;
  const YamlValue* const value = map.find(key);
  if (!value || value->kind == YamlValue::Kind::Null) return items;
  if (value->kind != YamlValue::Kind::List)
    map.fault(key, "a list is needed, not " + described(*value));
  for (const YamlValue& item : value->items) items.push_back(&item);
  return items;
}

std::optional<std::vector<double>> readNamed(const YamlMap& map, const char* key,
                                             const std::vector<std::string>& names) {
  const YamlValue* const value = map.find(key);
  if (!value || value->kind != YamlValue::Kind::Map) return map.numbers(key, names.size());
  const YamlMap inner(*value, map.pathOf(key), nullptr, map.source());
  std::vector<double> numbers;
  for (const std::string& name : names) {
    const auto number = inner.number(name);
    if (!number) {
      if (!inner.find(name)) inner.fault(name, "is missing");
      return std::nullopt;
    }
    numbers.push_back(*number);
  }
  return numbers;
}

std::string described(const YamlValue& value) {
  switch (value.kind) {
    case YamlValue::Kind::Scalar:
      return quotedWord(value.text) +
             (value.text == "..." ? " (ros2 topic echo --full-length writes whole lists)" : "");
    case YamlValue::Kind::List:
      return "a list";
    case YamlValue::Kind::Map:
      return "a map";
    default:
      return "nothing";
  }
}

namespace {

/// The key for which other programs use the name `key`, if it is legal.
std::optional<std::string> usualName(const std::string& key,
                                     const std::vector<std::string>& legal) {
  static const std::map<std::string, std::string> others{
      {"pos", "at"},          {"position", "at"},          {"xyz", "at"},
      {"origin", "at"},       {"translation", "at"},       {"pose", "at"},
      {"quat", "quat_xyzw"},  {"quaternion", "quat_xyzw"}, {"orientation", "quat_xyzw"},
      {"obstacles", "world"}, {"scene", "world"},          {"file", "mesh"},
      {"timeout", "time"}};
  const auto other = others.find(key);
  if (other == others.end() || std::find(legal.begin(), legal.end(), other->second) == legal.end())
    return std::nullopt;
  return other->second;
}

/// Returns an example of a map for messages: "such as {name: …}".
std::string exampleOf(const MapKeys* keys) {
  return keys && !keys->legal.empty() ? "such as {" + keys->legal.front() + ": …}" : "(key: value)";
}

/// Returns whether a text is a legal key and its value without the blank: "name:RRT".
bool lacksBlank(std::string_view text, const MapKeys* keys) {
  const std::size_t colon = text.find(':');
  return keys && colon != text.npos &&
         std::ranges::find(keys->legal, text.substr(0, colon)) != keys->legal.end();
}

/// Returns whether the value is a text of several numbers that are separated by blanks only.
bool isRowOfNumbers(const YamlValue& value) {
  if (value.kind != YamlValue::Kind::Scalar || value.text.find(',') != std::string::npos)
    return false;
  const std::vector<std::string> words = wordsOfLine(value.text);
  double number = 0;
  return words.size() > 1 && std::ranges::all_of(words, [&](const std::string& word) {
           return parseNumber(word, Range::Any, number).empty();
         });
}

}  // namespace

YamlMap::YamlMap(const YamlValue& value, std::string path, const MapKeys* keys, YamlSource& source,
                 std::string_view example)
    : path_(std::move(path)), source_(&source), line_(value.line) {
  if (value.kind != YamlValue::Kind::Map) {
    source.fault(line_,
                 (path_.empty() ? "" : path_ + ": ") + "a map " +
                     (example.empty() ? exampleOf(keys) : "such as " + std::string(example)) +
                     " is needed, not " + described(value) +
                     (lacksBlank(value.text, keys) ? "; write a blank after the colon" : ""));
    explainsMissing_ = true;
    return;
  }
  value.isOpened = true;
  const std::string in = path_.empty() ? "" : " in " + path_;
  for (const YamlValue::Entry& entry : value.entries) {
    if (const YamlValue::Entry* const first = entryOf(entry.key)) {
      source.fault(entry.line, "duplicate key " + quotedWord(entry.key) + in + ", first on line " +
                                   std::to_string(first->line));
      continue;
    }
    if (keys && std::find(keys->legal.begin(), keys->legal.end(), entry.key) == keys->legal.end()) {
      const auto unsupported =
          std::find_if(keys->unsupported.begin(), keys->unsupported.end(),
                       [&](const UnsupportedKey& k) { return k.key == entry.key; });
      if (unsupported != keys->unsupported.end()) {
        source.fault(entry.line,
                     quotedWord(entry.key) + in + " is not supported yet; " + unsupported->instead);
        explainsMissing_ = true;
        continue;
      }
      auto near = usualName(entry.key, keys->legal);
      const auto place = source.places.find(pathOf(entry.key));
      const bool isElsewhere = !near && place != source.places.end();
      if (!near && !isElsewhere) near = mostSimilar(entry.key, keys->legal);
      if (near) missed_.insert(*near);
      if (isElsewhere) missed_.insert(place->second.substr(0, place->second.find(':')));
      const std::string meant = near ? quotedWord(*near) : isElsewhere ? place->second : "";
      const bool blank = lacksBlank(entry.key, keys);
      source.fault(entry.line, "unknown key " + quotedWord(entry.key) + in +
                                   (blank           ? "; write a blank after the colon"
                                    : meant.empty() ? ""
                                                    : " (did you mean " + meant + "?)") +
                                   " (known: " + joined(keys->legal) + ")");
      continue;
    }
    entries_.push_back(&entry);
    index_.emplace(entry.key, &entry);
    source.lines.emplace(pathOf(entry.key), entry.line);
  }
}

std::string YamlMap::pathOf(std::string_view key) const {
  return path_.empty() ? std::string(key) : path_ + "." + std::string(key);
}

void YamlMap::fault(std::string_view key, const std::string& text) const {
  const YamlValue::Entry* const entry = entryOf(key);
  source_->fault(entry ? entry->line : line_, pathOf(key) + ": " + text);
}

const YamlValue::Entry* YamlMap::entryOf(std::string_view key) const {
  const auto found = index_.find(key);
  return found == index_.end() ? nullptr : found->second;
}

const YamlValue* YamlMap::find(std::string_view key) const {
  const YamlValue::Entry* const entry = entryOf(key);
  if (!entry) return nullptr;
  entry->use = YamlValue::Entry::Use::read;
  return &entry->value;
}

const std::vector<const YamlValue::Entry*>& YamlMap::entries() const {
  for (const YamlValue::Entry* const entry : entries_) entry->use = YamlValue::Entry::Use::read;
  return entries_;
}

void YamlMap::ignore(std::initializer_list<std::string_view> keys) const {
  for (const std::string_view key : keys)
    if (const YamlValue::Entry* const entry = entryOf(key))
      entry->use = YamlValue::Entry::Use::ignored;
}

const YamlValue* YamlMap::require(std::string_view key, const std::string& purpose) const {
  const YamlValue* value = find(key);
  if (!value && !explainsMissing_ && !missed_.contains(std::string(key)))
    source_->fault(path_.empty() ? 0 : line_, "missing key \"" + std::string(key) + "\"" +
                                                  (path_.empty() ? "" : " in " + path_) + ": " +
                                                  purpose);
  return value;
}

std::optional<std::string> YamlMap::requireOne(const std::vector<std::string>& keys,
                                               const std::string& what,
                                               const std::string& purpose) const {
  std::vector<std::string> given;
  for (const std::string& key : keys)
    if (find(key)) given.push_back(key);
  if (given.size() == 1) return given.front();
  if (given.size() > 1) {
    fault(given[1], what + " is needed, and " + given[0] + " is given already; leave one out");
    return std::nullopt;
  }
  const bool missed = std::any_of(keys.begin(), keys.end(),
                                  [&](const std::string& key) { return missed_.contains(key); });
  if (!explainsMissing_ && !missed)
    source_->fault(path_.empty() ? 0 : line_,
                   "missing " + what + (path_.empty() ? "" : " in " + path_) + ": " + purpose);
  return std::nullopt;
}

namespace {

/// Sets `number` and returns "", or returns an error message.
std::string parseNumber(const YamlValue& value, Range range, double& number) {
  if (value.kind != YamlValue::Kind::Scalar) return "a number is needed, not " + described(value);
  const std::string fault = parseNumber(value.text, range, number);
  if (value.isPlain || !fault.empty()) return fault;
  return "the number " + value.text + " is in quotes; remove them";
}

/// Returns a hint for a value that would be right without quotes, or "".
std::string hintOnQuotes(const YamlValue& value, bool isRight) {
  return value.kind == YamlValue::Kind::Scalar && !value.isPlain && isRight
             ? "; write it without quotes"
             : "";
}

}  // namespace

std::optional<double> readNumber(const YamlValue& value, Range range, const std::string& path,
                                 const YamlSource& source) {
  double result = 0;
  const std::string complaint = parseNumber(value, range, result);
  if (complaint.empty()) return result;
  source.fault(value.line, path + ": " + complaint);
  return std::nullopt;
}

std::optional<double> YamlMap::number(std::string_view key, Range range) const {
  const YamlValue* value = find(key);
  if (!value) return std::nullopt;
  double result = 0;
  const std::string complaint = parseNumber(*value, range, result);
  if (complaint.empty()) return result;
  fault(key, complaint);
  return std::nullopt;
}

std::optional<double> YamlMap::quotableNumber(std::string_view key, Range range) const {
  const YamlValue* const value = find(key);
  double result = 0;
  return value && value->kind == YamlValue::Kind::Scalar &&
                 parseNumber(value->text, range, result).empty()
             ? result
             : number(key, range);
}

std::optional<std::uint64_t> YamlMap::wholeNumber(std::string_view key,
                                                  const WholeRange& range) const {
  const YamlValue* value = find(key);
  if (!value) return std::nullopt;
  std::uint64_t result = 0;
  const char* const end = value->text.data() + value->text.size();
  const auto [stop, error] = std::from_chars(value->text.data(), end, result);
  const bool isRight = value->kind == YamlValue::Kind::Scalar && stop == end &&
                       error == std::errc() && range.least <= result && result <= range.most;
  if (isRight && value->isPlain) return result;
  fault(key, "a whole number from " + std::string(range.words) + " is needed, not " +
                 described(*value) + hintOnQuotes(*value, isRight));
  return std::nullopt;
}

std::optional<bool> YamlMap::boolean(std::string_view key) const {
  const YamlValue* value = find(key);
  if (!value) return std::nullopt;
  const bool isRight = value->text == "true" || value->text == "false";
  if (isRight && value->isPlain) return value->text == "true";
  fault(key, "true or false is needed, not " + described(*value) + hintOnQuotes(*value, isRight));
  return std::nullopt;
}

std::optional<bool> YamlMap::flag(std::string_view key) const {
  const YamlValue* value = find(key);
  if (!value) return std::nullopt;
  const std::string word = value->isPlain ? lowered(value->text) : "";
  if (word == "true" || word == "false") return word == "true";
  fault(key, "true or false is needed, not " + described(*value));
  return std::nullopt;
}

std::optional<std::string> YamlMap::text(std::string_view key) const {
  const YamlValue* value = find(key);
  if (!value) return std::nullopt;
  if (value->kind == YamlValue::Kind::Scalar && !value->text.empty()) return value->text;
  fault(key, "a word is needed, not " +
                 (value->kind == YamlValue::Kind::Scalar ? "nothing" : described(*value)));
  return std::nullopt;
}

std::string YamlMap::textOrNone(std::string_view key) const {
  const YamlValue* const value = find(key);
  const bool isNone = !value || value->kind == YamlValue::Kind::Null ||
                      (value->kind == YamlValue::Kind::Scalar && value->text.empty());
  return isNone ? "" : text(key).value_or("");
}

std::optional<std::string> YamlMap::choice(std::string_view key,
                                           const std::vector<std::string>& of) const {
  const YamlValue* value = find(key);
  if (!value) return std::nullopt;
  if (value->kind == YamlValue::Kind::Scalar &&
      std::find(of.begin(), of.end(), value->text) != of.end())
    return value->text;
  fault(key, value->kind == YamlValue::Kind::Scalar
                 ? notOneOf(value->text, of)
                 : "one of " + joined(of) + " is needed, not " + described(*value));
  return std::nullopt;
}

std::optional<std::vector<double>> readNumbers(const YamlValue& value, std::size_t count,
                                               const std::string& path, const YamlSource& source) {
  const bool isList = value.kind == YamlValue::Kind::List;
  const bool lacksCommas = std::ranges::any_of(value.items, isRowOfNumbers);
  if (!isList || value.items.size() != count || lacksCommas) {
    source.fault(value.line, path + ": a list of " + std::to_string(count) +
                                 " numbers is needed, not " + described(value) +
                                 (isList ? " of " + std::to_string(value.items.size()) : "") +
                                 (lacksCommas ? "; write commas between the numbers" : ""));
    return std::nullopt;
  }
  std::vector<double> numbers(count);
  bool sound = true;
  for (std::size_t i = 0; i < count; ++i) {
    const auto number = readNumber(value.items[i], Range::Any, path, source);
    numbers[i] = number.value_or(0);
    sound &= number.has_value();
  }
  return sound ? std::optional(numbers) : std::nullopt;
}

std::optional<std::vector<std::string>> readWords(const YamlValue& value, const std::string& form,
                                                  const std::string& path,
                                                  const YamlSource& source) {
  std::vector<std::string> words;
  for (const YamlValue& item : value.items)
    if (item.kind == YamlValue::Kind::Scalar && !item.text.empty()) words.push_back(item.text);
  if (value.kind == YamlValue::Kind::List && words.size() == value.items.size()) return words;
  source.fault(value.line, path + ": a list of names is needed, " + form + ", not " +
                               (value.kind == YamlValue::Kind::List ? "one with other values in it"
                                                                    : described(value)));
  return std::nullopt;
}

std::optional<std::vector<double>> YamlMap::numbers(std::string_view key, std::size_t count) const {
  const YamlValue* value = find(key);
  return value ? readNumbers(*value, count, pathOf(key), *source_) : std::nullopt;
}

std::optional<double> YamlMap::angle(const std::string& key, Range range) const {
  const std::string degrees = key + "_deg";
  if (find(key) && find(degrees)) {
    fault(degrees, "say " + key + " (radians) or " + degrees + " (degrees), not both");
    return std::nullopt;
  }
  if (find(key)) return number(key, range);
  const auto value = number(degrees, range);
  return value ? std::optional(*value * (std::numbers::pi / 180)) : std::nullopt;
}

}  // namespace corridor
