#include "planner/problem/yaml_value.h"

#include <algorithm>
#include <map>
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
};

/// Returns a line of the text, counted from 0; "" if there is no such line.
std::string lineOf(const std::string& text, int line) {
  std::istringstream stream(text);
  std::string found;
  for (int i = 0; i <= line; ++i)
    if (!std::getline(stream, found)) return "";
  return found;
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

}  // namespace

YamlValue parseYaml(const std::string& file, const std::string& text, const YamlLimits& limits) {
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    TreeBuilder first(file, limits), second(file, limits);
    parser.HandleNextDocument(first);
    if (parser.HandleNextDocument(second))
      throw InputError(Fault{file, 0, "has more than one YAML document (---); keep one"});
    return first.take();
  } catch (const YAML::Exception& error) {
    throw InputError(Fault{file, error.mark.line + 1,
                           "is not YAML: " + explained(error, lineOf(text, error.mark.line))});
  }
}

}  // namespace corridor
