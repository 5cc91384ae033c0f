#include "planner/problem/yaml_value.h"

#include <algorithm>
#include <map>
#include <optional>
#include <sstream>
#include <utility>

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include "collision/core/error.h"

namespace corridor {
namespace {

/// Builds the document from the parser's events, since yaml-cpp's own nodes hide repeated keys.
class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(std::string file, const YamlLimits& limits)
      : file_(std::move(file)), limits_(limits) {}

  YamlValue take() { return std::move(root_); }
  bool endsWithQuotedScalar() const { return endsWithQuotedScalar_; }

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
    scalar.text = text;
    // The tag of yaml-cpp is "?" for plain text, "!" for quoted text, else the tag in the file.
    scalar.isPlain = tag == "?";
    endsWithQuotedScalar_ = !scalar.isPlain;
    put(std::move(scalar));
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    open(value(YamlValue::Kind::List, mark));
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
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

  void requireNoKey(const YamlValue& value) const {
    if (!open_.empty() && open_.back().value.kind == YamlValue::Kind::Map && open_.back().keyIsNext)
      throw InputError(Fault{file_, value.line, "a key must be a word"});
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
  YamlLimits limits_;
  YamlValue root_;
  std::vector<Open> open_;
  std::size_t nodes_ = 0;
  bool endsWithQuotedScalar_ = false;
};

/// Returns a line of the text, counted from 0; "" if there is no such line.
std::string lineOf(const std::string& text, int line) {
  std::istringstream stream(text);
  std::string found;
  for (int i = 0; i <= line; ++i)
    if (!std::getline(stream, found)) return "";
  return found;
}

/// Passes the documents of the text to the two builders. Returns whether there is a second one.
/// @throws YAML::Exception for a syntax error.
bool readDocuments(const std::string& text, TreeBuilder& first, TreeBuilder& second) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  parser.HandleNextDocument(first);
  return parser.HandleNextDocument(second);
}

/// Returns whether the text ends inside quotes.
bool endsInQuotes(const std::string& text) {
  TreeBuilder first("", {}), second("", {});
  try {
    // yaml-cpp 0.7 misses the end of the text behind a line break. It does not miss the end behind
    // a comment.
    readDocuments(text + "\n#", first, second);
  } catch (const YAML::Exception& error) {
    return error.msg == YAML::ErrorMsg::EOF_IN_SCALAR;
  } catch (const InputError&) {
  }
  return false;
}

/// Returns the line, counted from 0, where the quotes open in which the first `lines` lines of the
/// text end; nullopt if these lines end outside of quotes.
std::optional<int> lineOfOpenQuote(const std::string& text, int lines) {
  std::vector<std::size_t> ends{0};  // ends[n]: the length of the first n lines
  for (std::size_t at = 0; static_cast<int>(ends.size()) <= lines && at < text.size();) {
    at = std::min(text.find('\n', at), text.size() - 1) + 1;
    ends.push_back(at);
  }
  const auto isInside = [&](std::size_t n) { return endsInQuotes(text.substr(0, ends[n])); };
  std::size_t outside = 0, inside = ends.size() - 1;
  if (!isInside(inside)) return std::nullopt;
  while (inside - outside > 1) {
    const std::size_t middle = (inside + outside) / 2;
    (isInside(middle) ? inside : outside) = middle;
  }
  return static_cast<int>(outside);
}

/// Returns the number of lines up to the last one that is not blank, at least 1.
int linesOf(const std::string& text) {
  const auto size = static_cast<std::ptrdiff_t>(text.find_last_not_of(" \t\r\n") + 1);
  return static_cast<int>(std::count(text.begin(), text.begin() + size, '\n')) + 1;
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
      {BLOCK_ENTRY,
       "\"- \" begins a list item; it must begin its line, and can't be inside [ ] or { }"},
      {MAP_VALUE,
       "a colon can't be here; perhaps this line or the line above lacks a colon or the blank "
       "after "
       "it; a map on one line needs braces, {key: value}, and a text with a colon needs quotes"}};
  const auto found = texts.find(error.msg);
  return found == texts.end() ? error.msg : found->second;
}

/// Returns the fault of a quote that is not closed; nullopt if there is none.
std::optional<Fault> unclosedQuote(const std::string& file, const std::string& text) {
  const auto line = lineOfOpenQuote(text, linesOf(text));
  if (!line) return std::nullopt;
  return Fault{file, *line + 1, "is not YAML: a quote on this line is not closed"};
}

/// Returns the fault that explains the parser's error.
Fault faultOf(const YAML::Exception& error, const std::string& file, const std::string& text) {
  if (const auto fault = unclosedQuote(file, text)) return *fault;
  const int line = std::clamp(error.mark.line, 0, linesOf(text) - 1);
  if (const auto open = lineOfOpenQuote(text, line))
    return {file, *open + 1,
            "is not YAML: a quote on this line is closed only on line " + std::to_string(line + 1) +
                "; is one missing?"};
  return {file, line + 1, "is not YAML: " + explained(error, lineOf(text, line))};
}

}  // namespace

YamlValue parseYaml(const std::string& file, const std::string& text, const YamlLimits& limits) {
  TreeBuilder first(file, limits), second(file, limits);
  bool hasSecond = false;
  try {
    hasSecond = readDocuments(text, first, second);
  } catch (const YAML::Exception& error) {
    throw InputError(faultOf(error, file, text));
  } catch (const InputError&) {  // an open quote can make a key of what follows
    if (const auto fault = unclosedQuote(file, text)) throw InputError(*fault);
    throw;
  }
  if (hasSecond)
    throw InputError(Fault{file, 0, "has more than one YAML document (---); keep one"});
  // If a quote is not closed, yaml-cpp takes the rest of the text as part of the quoted value.
  if (first.endsWithQuotedScalar())
    if (const auto fault = unclosedQuote(file, text)) throw InputError(*fault);
  return first.take();
}

}  // namespace corridor
