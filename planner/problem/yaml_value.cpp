#include "planner/problem/yaml_value.h"

#include <algorithm>
#include <map>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include "collision/core/error.h"
#include "collision/core/read_file.h"
#include "collision/core/text_encoding.h"

namespace corridor {
namespace {

/// What yaml-cpp makes of "!!".
const std::string kStandardTag = "tag:yaml.org,2002:";

/// Returns whether the text is in UTF-16 or UTF-32, which yaml-cpp also reads.
bool hasWideCharacters(const std::string& text) {
  return text.find('\0') != text.npos;
}

/// Returns the position of the quote that closes the one at `open`, or npos.
std::size_t closingQuote(std::string_view text, std::size_t open) {
  const char quote = text[open];
  for (std::size_t i = open + 1; i < text.size(); ++i) {
    if (text[i] == quote) {
      if (quote == '"' || text.substr(i, 2) != "''") return i;
      ++i;  // '' stands for one quote
    } else if (quote == '"' && text[i] == '\\') {
      ++i;
    }
  }
  return text.npos;
}

/// Returns whether a line looks like a key with its value, or like an item of a list.
bool looksLikeKeyOrItem(std::string_view line) {
  const std::string_view blanks = " \t\r";
  line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
  if (line.starts_with("- ")) return true;
  const std::size_t end = std::min(line.find_first_of(" \t\r:"), line.size());
  return end > 0 && end < line.size() && line[end] == ':' &&
         (end + 1 == line.size() || blanks.find(line[end + 1]) != blanks.npos);
}

/// Returns whether a tag stands for numbers, truth values or nothing, as plain text does.
bool isPlainTag(const std::string& tag) {
  return tag == "?" || tag == kStandardTag + "float" || tag == kStandardTag + "int" ||
         tag == kStandardTag + "bool" || tag == kStandardTag + "null";
}

/// Returns whether a tag, as yaml-cpp passes it on, says no more than what the value's form says.
/// yaml-cpp's own tags are "?" for values without a tag, and "!" for texts in quotes. Python writes
/// its tuples with a tag.
bool saysNothing(const std::string& tag, YamlValue::Kind kind) {
  if (tag.empty() || tag == "?" || tag == "!") return true;
  if (kind == YamlValue::Kind::Map) return tag == kStandardTag + "map";
  if (kind == YamlValue::Kind::List)
    return tag == kStandardTag + "seq" || tag == kStandardTag + "python/tuple";
  return tag == kStandardTag + "str" || isPlainTag(tag);
}

/// Returns a tag as it is in the file: "!!float", "!cm".
std::string tagAsWritten(const std::string& tag) {
  return tag.starts_with(kStandardTag) ? "!!" + tag.substr(kStandardTag.size()) : tag;
}

/// Builds the document from the parser's events, since yaml-cpp's own nodes hide repeated keys.
class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(std::string file, std::string_view text, const YamlLimits& limits)
      : file_(std::move(file)), text_(text), limits_(limits) {}

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

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override {
    put(value(YamlValue::Kind::Null, mark));
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    fail(mark, "aliases (*name) are not read here; write the value out");
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                const std::string& text) override {
    YamlValue scalar = value(YamlValue::Kind::Scalar, mark);
    scalar.inDegrees = limits_.angleTags && tag == "!degrees";
    const bool isAngle = scalar.inDegrees || (limits_.angleTags && tag == "!radians");
    if (!isAngle) requireNoTag(mark, tag, YamlValue::Kind::Scalar);
    scalar.text = text;
    scalar.isPlain = isAngle || isPlainTag(tag);
    if (!scalar.isPlain) checkQuotes(mark);
    put(std::move(scalar));
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    requireNoTag(mark, tag, YamlValue::Kind::List);
    open(value(YamlValue::Kind::List, mark));
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    requireNoTag(mark, tag, YamlValue::Kind::Map);
    open(value(YamlValue::Kind::Map, mark));
  }
  void OnMapEnd() override { close(); }

 private:
  struct Open {
    YamlValue value;
    bool keyIsNext = true;  ///< Map: the next value is a key
  };

  YamlValue value(YamlValue::Kind kind, const YAML::Mark& mark) {
    if (++nodes_ > limits_.nodes)
      fail(mark,
           "has more than " + std::to_string(limits_.nodes) + " keys and values; split the file");
    YamlValue result;
    result.kind = kind;
    result.line = mark.line + 1;
    return result;
  }

  [[noreturn]] void fail(const YAML::Mark& mark, std::string text) const {
    throw InputError(Fault{file_, mark.line + 1, std::move(text)});
  }

  /// Refuses tags: `at: !cm [1, 2, 3]` is meant as centimetres, and no reader knows that.
  void requireNoTag(const YAML::Mark& mark, const std::string& tag, YamlValue::Kind kind) const {
    if (saysNothing(tag, kind)) return;
    fail(mark, "tags (" + tagAsWritten(tag) + ") are not read here; write the value without it" +
                   (tag == "!degrees" || tag == "!radians" ? ", in the unit of its key" : ""));
  }

  /// Refuses quotes that are not closed: yaml-cpp takes the rest of the file as part of the value.
  /// Refuses quotes that are closed on a later line, if what looks like a key is between: these
  /// keys would be lost, for example a margin.
  void checkQuotes(const YAML::Mark& mark) {
    auto at = static_cast<std::size_t>(mark.pos);
    while (at < text_.size() && (text_[at] == '!' || text_[at] == '&'))  // a tag, an anchor
      at = text_.find_first_not_of(" \t", std::min(text_.find_first_of(" \t", at), text_.size()));
    if (at >= text_.size() || (text_[at] != '"' && text_[at] != '\'')) return;
    const std::size_t close = closingQuote(text_, at);
    if (close == text_.npos) fail(mark, "is not YAML: a quote on this line is not closed");
    std::string_view inside = text_.substr(at, close - at);
    std::size_t end = inside.find('\n');
    if (end == inside.npos) return;
    firstLineOfQuotes_ = mark.line;
    lastLineOfQuotes_ =
        mark.line + static_cast<int>(std::count(inside.begin(), inside.end(), '\n'));
    while (end != inside.npos) {
      inside.remove_prefix(end + 1);
      end = inside.find('\n');
      if (looksLikeKeyOrItem(inside.substr(0, end)))
        fail(mark, "a quote on this line is closed only on line " +
                       std::to_string(lastLineOfQuotes_ + 1) +
                       ", behind what looks like a key or an item; is a quote missing? If not, "
                       "write the text on one line");
    }
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
  std::string_view text_;
  YamlLimits limits_;
  YamlValue root_;
  std::vector<Open> open_;
  std::size_t nodes_ = 0;
  std::optional<Fault> wrongKey_;
  /// The lines of the last value in quotes that has several lines; -1 if there is none.
  int firstLineOfQuotes_ = -1, lastLineOfQuotes_ = -1;
};

/// Returns a line of the text, counted from 0; "" if there is no such line.
std::string lineOf(const std::string& text, int line) {
  std::istringstream stream(text);
  std::string found;
  for (int i = 0; i <= line; ++i)
    if (!std::getline(stream, found)) return "";
  return found;
}

/// Returns the number of lines up to the last one that is not blank, at least 1.
int linesOf(const std::string& text) {
  const auto size = static_cast<std::ptrdiff_t>(text.find_last_not_of(" \t\r\n") + 1);
  return static_cast<int>(std::count(text.begin(), text.begin() + size, '\n')) + 1;
}

/// Returns the text without the lines `---` at its end, which begin documents that are empty.
std::string_view withoutLastMarks(std::string_view text) {
  for (;;) {
    const std::string_view rest = text.substr(0, text.find_last_not_of(" \t\r\n") + 1);
    if (!rest.ends_with("\n---")) return text;
    text = rest.substr(0, rest.size() - 3);
  }
}

/// Returns the line of a directive (%YAML …) that follows other lines than directives and comments,
/// which yaml-cpp drops; 0 if there is none.
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

/// Returns a clearer message for the faults that people make most, or else yaml-cpp's message.
std::string explained(const YAML::Exception& error, const std::string& line) {
  using namespace YAML::ErrorMsg;
  const std::size_t indent = line.find_first_not_of(" \t");
  const auto column = static_cast<std::size_t>(std::max(error.mark.column, 0));
  if (line.substr(0, indent).find('\t') != line.npos)
    return "the line is indented by a tab; use blanks";
  if (error.msg == END_OF_MAP || error.msg == END_OF_SEQ) {
    if (indent < column && column <= line.size())
      return "nothing may follow the value on this line";
    return "\"key: value\" or \"- value\" is needed here, indented like the lines above it, and "
           "with a blank after the colon or the minus";
  }
  if (error.msg == UNKNOWN_TOKEN && column < line.size() && ' ' < line[column] &&
      line[column] < 0x7f)
    return std::string("a text that begins with ") + line[column] + " must be in quotes";
  static const std::map<std::string, const char*> texts{
      {END_OF_MAP_FLOW, "a comma, a } or the blank after a colon is missing, here or above"},
      {END_OF_SEQ_FLOW, "a comma or a ] is missing, here or above"},
      {FLOW_END, "a } or ] is missing, or there is one too many"},
      {EOF_IN_SCALAR, "a quote above is not closed"},
      {DOC_IN_SCALAR, "a quote above is not closed"},
      {BLOCK_ENTRY,
       "\"- \" begins a list item; it must begin its line, and can't be inside [ ] or { }"},
      {MAP_VALUE,
       "a colon can't be here; perhaps this line or the line above lacks a colon or the blank "
       "after "
       "it; a map on one line needs braces, {key: value}, and a text with a colon needs quotes"}};
  const auto found = texts.find(error.msg);
  return found == texts.end() ? error.msg : found->second;
}

}  // namespace

YamlValue parseYaml(const std::string& file, const std::string& given, const YamlLimits& limits) {
  const std::string text = withLineFeeds(given);  // yaml-cpp ends comments at LF only
  const bool isWide = hasWideCharacters(text);  // then positions of yaml-cpp are not those of bytes
  if (!isWide) requireUtf8(text, file);
  const std::string_view utf8 = isWide ? "" : withoutLastMarks(withoutByteOrderMark(text));
  if (const int line = lateDirective(utf8); line > 0)
    throw InputError(Fault{file, line,
                           "a line that begins with % is not read after the first lines; "
                           "remove it, or put the value in quotes"});
  TreeBuilder first(file, utf8, limits), second(file, utf8, limits);
  try {
    // With the line break, yaml-cpp also passes on the last value if its quote is not closed.
    std::istringstream stream(isWide ? text : std::string(utf8) + "\n");
    YAML::Parser parser(stream);
    parser.HandleNextDocument(first);
    if (parser.HandleNextDocument(second))
      throw InputError(Fault{file, 0, "has more than one YAML document (---); keep one"});
    return first.take();
  } catch (const YAML::Exception& error) {
    const int line = std::clamp(error.mark.line, 0, linesOf(text) - 1);
    throw InputError(
        Fault{file, line + 1,
              "is not YAML: " + explained(error, lineOf(text, line)) + first.remarkOnQuotes(line)});
  }
}

}  // namespace corridor
