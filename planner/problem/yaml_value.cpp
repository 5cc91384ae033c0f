#include "planner/problem/yaml_value.h"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

#include "collision/core/error.h"
#include "collision/core/read_file.h"
#include "collision/core/text_encoding.h"
#include "planner/problem/yaml_events.h"

namespace corridor {
namespace {

/// Returns whether the text is in UTF-16, which libyaml also reads.
bool hasWideCharacters(const std::string& text) {
  return text.find('\0') != text.npos;
}

/// Returns whether a line, or a part of it, looks like a key with its value, like an item of a
/// list, or like a part of a list or map in brackets.
bool looksLikeYaml(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t\r");
  if (first == line.npos) return false;
  line = line.substr(first, line.find_last_not_of(" \t\r") + 1 - first);
  if (line == "-" || line.ends_with(':') || line.find_first_of("{}[]") != line.npos) return true;
  for (const char* const text : {"- ", "-\t", "? ", "?\t"})
    if (line.starts_with(text)) return true;
  for (const char* const text : {": ", ":\t", "\":", "':"})
    if (line.find(text) != line.npos) return true;
  return false;
}

/// The start of the standard tags: of "!!str", for example.
const std::string kStandardTag = "tag:yaml.org,2002:";

/// Returns a tag of an event, or "" if it has none.
std::string tagOf(const yaml_char_t* tag) {
  return tag ? reinterpret_cast<const char*>(tag) : "";
}

/// Returns whether a tag stands for numbers, truth values or nothing, as plain text does.
bool isPlainTag(const std::string& tag) {
  return tag == kStandardTag + "float" || tag == kStandardTag + "int" ||
         tag == kStandardTag + "bool" || tag == kStandardTag + "null";
}

/// Returns whether a tag says no more than what the value's form says. Python writes its tuples
/// with a tag.
bool saysNothing(const std::string& tag, YamlValue::Kind kind) {
  if (tag.empty() || tag == "!") return true;
  if (kind == YamlValue::Kind::Map) return tag == kStandardTag + "map";
  if (kind == YamlValue::Kind::List)
    return tag == kStandardTag + "seq" || tag == kStandardTag + "python/tuple";
  return tag == kStandardTag + "str" || isPlainTag(tag);
}

/// Returns a tag as it is in the file: "!!float", "!cm".
std::string tagAsWritten(const std::string& tag) {
  return tag.starts_with(kStandardTag) ? "!!" + tag.substr(kStandardTag.size()) : tag;
}

/// Returns whether a plain text stands for no value (YAML 1.2, 10.2.1.1).
bool isNull(std::string_view text) {
  return text.empty() || text == "~" || text == "null" || text == "Null" || text == "NULL";
}

/// Builds a document from libyaml's events.
class TreeBuilder {
 public:
  TreeBuilder(const std::string& file, std::string_view text, const YamlLimits& limits)
      : file_(file), rest_(text), limits_(limits) {}

  /// Returns the document. @throws InputError if a key is no word.
  YamlValue take() {
    if (wrongKey_) throw InputError(*wrongKey_);
    return std::move(root_);
  }

  /// Returns a remark for a fault on the line (counted from 0) where quotes of an earlier line are
  /// closed; "" for other lines.
  std::string remarkOnQuotes(int line) const {
    if (line != lastLineOfQuotes_) return "";
    return "; the quote on line " + std::to_string(firstLineOfQuotes_ + 1) +
           " is closed only here: is one missing?";
  }

  void add(const yaml_event_t& event) {
    const int line = static_cast<int>(event.start_mark.line);
    switch (event.type) {
      case YAML_ALIAS_EVENT:
        fail(line, "aliases (*name) are not read here; write the value out");
      case YAML_SCALAR_EVENT:
        return addScalar(event);
      case YAML_SEQUENCE_START_EVENT:
        requireNoTag(line, tagOf(event.data.sequence_start.tag), YamlValue::Kind::List);
        return open(value(YamlValue::Kind::List, line));
      case YAML_MAPPING_START_EVENT:
        requireNoTag(line, tagOf(event.data.mapping_start.tag), YamlValue::Kind::Map);
        return open(value(YamlValue::Kind::Map, line));
      case YAML_SEQUENCE_END_EVENT:
      case YAML_MAPPING_END_EVENT:
        return close();
      default:
        return;
    }
  }

 private:
  struct Open {
    YamlValue value;
    bool keyIsNext = true;  ///< Map: the next value is a key
  };

  void addScalar(const yaml_event_t& event) {
    const auto& given = event.data.scalar;
    const int line = static_cast<int>(event.start_mark.line);
    const std::string tag = tagOf(given.tag);
    YamlValue scalar = value(YamlValue::Kind::Scalar, line);
    scalar.inDegrees = limits_.angleTags && tag == "!degrees";
    const bool isAngle = scalar.inDegrees || (limits_.angleTags && tag == "!radians");
    if (!isAngle) requireNoTag(line, tag, YamlValue::Kind::Scalar);
    scalar.text.assign(reinterpret_cast<const char*>(given.value), given.length);
    const bool isQuoted = given.style == YAML_SINGLE_QUOTED_SCALAR_STYLE ||
                          given.style == YAML_DOUBLE_QUOTED_SCALAR_STYLE;
    const bool hasNone = given.style == YAML_PLAIN_SCALAR_STYLE && tag.empty();
    scalar.isPlain = hasNone || isAngle || isPlainTag(tag);
    if (hasNone && isNull(scalar.text)) scalar.kind = YamlValue::Kind::Null;
    if (isQuoted) checkQuotes(event.start_mark, event.end_mark);
    put(std::move(scalar));
  }

  YamlValue value(YamlValue::Kind kind, int line) {
    if (++nodes_ > limits_.nodes)
      fail(line,
           "has more than " + std::to_string(limits_.nodes) + " keys and values; split the file");
    YamlValue result;
    result.kind = kind;
    result.line = line + 1;
    return result;
  }

  [[noreturn]] void fail(int line, std::string text) const {
    throw InputError(Fault{file_, line + 1, std::move(text)});
  }

  /// Refuses tags: `at: !cm [1, 2, 3]` is meant as centimetres, and no reader knows that.
  void requireNoTag(int line, const std::string& tag, YamlValue::Kind kind) const {
    if (saysNothing(tag, kind)) return;
    fail(line, "tags (" + tagAsWritten(tag) + ") are not read here; write the value without it" +
                   (tag == "!degrees" || tag == "!radians" ? ", in the unit of its key" : ""));
  }

  /// Refuses quotes that are closed on a later line, if what looks like a key is between: these
  /// keys would be lost, for example a margin.
  void checkQuotes(const yaml_mark_t& open, const yaml_mark_t& close) {
    if (open.line == close.line) return;
    bool isInside = false;
    for (std::size_t line = open.line; line <= close.line; ++line) {
      skipTo(line);
      const std::string_view whole = rest_.substr(0, rest_.find('\n'));
      std::size_t begin = 0;
      if (!isInside) {  // the mark may be that of a tag, on a line above the quote
        begin = line == open.line ? byteOfColumn(whole, open.column) : 0;
        begin = whole.find_first_of("\"'", begin);
        if (begin == whole.npos) continue;
        if (line == close.line) return;  // the text is on one line
        ++begin;
        isInside = true;
        firstLineOfQuotes_ = static_cast<int>(line);
        lastLineOfQuotes_ = static_cast<int>(close.line);
      }
      const std::size_t end = line == close.line ? byteOfColumn(whole, close.column) : whole.size();
      if (looksLikeYaml(whole.substr(begin, end - begin)))
        fail(firstLineOfQuotes_, "a quote on this line is closed only on line " +
                                     std::to_string(lastLineOfQuotes_ + 1) +
                                     ", behind what looks like a key or an item; is a quote "
                                     "missing? If not, write the text on one line");
    }
  }

  /// Drops the lines before a line from `rest_`. Quotes come in the order of their lines.
  void skipTo(std::size_t line) {
    for (; lineOfRest_ < line; ++lineOfRest_)
      rest_.remove_prefix(std::min(std::min(rest_.find('\n'), rest_.size()) + 1, rest_.size()));
  }

  void open(YamlValue value) {
    requireNoKey(value);
    if (open_.size() == limits_.depth)
      throw InputError(Fault{file_, value.line,
                             "has lists and maps nested more than " +
                                 std::to_string(limits_.depth) +
                                 " deep; no valid file needs more"});
    open_.push_back({std::move(value), true});
  }

  void close() {
    YamlValue done = std::move(open_.back().value);
    open_.pop_back();
    put(std::move(done));
  }

  /// Notes a key that is no word. If a } or ] is missing, the parser passes on such keys before it
  /// reports the missing bracket, or an open quote behind it. So `take` reports the key.
  void requireNoKey(const YamlValue& value) {
    if (!open_.empty() && open_.back().value.kind == YamlValue::Kind::Map &&
        open_.back().keyIsNext && !wrongKey_)
      wrongKey_ = Fault{file_, value.line, "a key must be a word"};
  }

  void put(YamlValue value) {
    if (open_.empty()) {
      root_ = std::move(value);
      return;
    }
    Open& parent = open_.back();
    if (parent.value.kind == YamlValue::Kind::List) {
      parent.value.items.push_back(std::move(value));
      return;
    }
    if (parent.keyIsNext) {
      if (value.kind != YamlValue::Kind::Scalar) requireNoKey(value);
      parent.value.entries.push_back({std::move(value.text), value.line, {}});
    } else {
      parent.value.entries.back().value = std::move(value);
    }
    parent.keyIsNext = !parent.keyIsNext;
  }

  std::string file_;
  std::string_view rest_;  ///< the text from a line on
  std::size_t lineOfRest_ = 0;
  YamlLimits limits_;
  YamlValue root_;
  std::vector<Open> open_;
  std::size_t nodes_ = 0;
  std::optional<Fault> wrongKey_;
  /// The lines of the last value in quotes that has several lines; -1 if there is none.
  int firstLineOfQuotes_ = -1, lastLineOfQuotes_ = -1;
};

/// Returns the text without the lines `---` at its end, which begin documents that are empty.
std::string_view withoutLastMarks(std::string_view text) {
  for (;;) {
    const std::string_view rest = text.substr(0, text.find_last_not_of(" \t\r\n") + 1);
    if (!rest.ends_with("\n---")) return text;
    text = rest.substr(0, rest.size() - 3);
  }
}

/// Refuses characters that end a line in YAML 1.1, as libyaml reads it, but not in YAML 1.2: what
/// follows them in a comment would be read. @throws InputError
void requireOneKindOfLineEnd(std::string_view text, const std::string& file) {
  for (const auto& [bytes, name] :
       {std::pair("\xc2\x85", "U+0085"), {"\xe2\x80\xa8", "U+2028"}, {"\xe2\x80\xa9", "U+2029"}}) {
    const std::size_t at = text.find(bytes);
    if (at == text.npos) continue;
    const auto line = 1 + std::count(text.begin(), text.begin() + std::ptrdiff_t(at), '\n');
    throw InputError(Fault{file, static_cast<int>(line),
                           std::string("the character ") + name +
                               " ends a line in YAML 1.1, but not in 1.2; replace it"});
  }
}

/// Returns the line of a directive (%YAML …) that follows other lines than directives and comments;
/// 0 if there is none.
int lateDirective(std::string_view text) {
  bool isLate = false;
  int number = 0;
  for (std::size_t begin = 0; begin < text.size(); ++number) {
    const std::string_view line = text.substr(begin, text.find('\n', begin) - begin);
    begin += line.size() + 1;
    if (line.starts_with('%') && isLate) return number + 1;
    isLate |=
        line.find_first_not_of(" \t\r") != line.npos && line.front() != '%' && line.front() != '#';
  }
  return 0;
}

}  // namespace

YamlValue parseYaml(const std::string& file, const std::string& given, const YamlLimits& limits) {
  const std::string text = withLineFeeds(given);
  const bool isWide = hasWideCharacters(text);
  if (!isWide) requireUtf8(text, file);
  const std::string_view utf8 = isWide ? "" : withoutLastMarks(withoutByteOrderMark(text));
  requireOneKindOfLineEnd(utf8, file);
  if (const int line = lateDirective(utf8); line > 0)
    throw InputError(Fault{file, line,
                           "a line that begins with % is not read after the first lines; "
                           "remove it, or put the value in quotes"});
  TreeBuilder document(file, utf8, limits);
  YamlEvents events(isWide ? std::string_view(text) : utf8);
  for (int documents = 0; const yaml_event_t* const event = events.next();) {
    if (event->type == YAML_DOCUMENT_START_EVENT && ++documents > 1)
      throw InputError(Fault{file, static_cast<int>(event->start_mark.line) + 1,
                             "has more than one YAML document (---); keep one"});
    document.add(*event);
  }
  if (const auto& fault = events.fault())
    throw InputError(Fault{file, fault->line + 1,
                           "is not YAML: " + fault->text + document.remarkOnQuotes(fault->line)});
  return document.take();
}

}  // namespace corridor
