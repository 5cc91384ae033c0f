#include "planner/problem/yaml_events.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <new>

#include "collision/core/text_encoding.h"

namespace corridor {
namespace {

/// Returns a line of the text, counted from 0; "" if there is no such line.
std::string_view lineOf(std::string_view text, int line) {
  for (; line > 0; --line)
    text.remove_prefix(std::min(std::min(text.find('\n'), text.size()) + 1, text.size()));
  return text.substr(0, text.find('\n'));
}

/// Returns the number of lines up to the last one that is not blank, at least 1.
int linesOf(std::string_view text) {
  const auto size = static_cast<std::ptrdiff_t>(text.find_last_not_of(" \t\r\n") + 1);
  return static_cast<int>(std::count(text.begin(), text.begin() + size, '\n')) + 1;
}

constexpr const char* kItemInside =
    "\"- \" begins a list item; it must begin its line, and can't be inside [ ] or { }";

/// A message of libyaml and a clearer one for users.
struct Message {
  std::string_view problem;
  const char* text;
};
constexpr std::array kMessages = {
    Message{"did not find expected ',' or '}'",
            "a comma, a } or the blank after a colon is missing, here or above"},
    Message{"did not find expected ',' or ']'", "a comma or a ] is missing, here or above"},
    Message{"found unexpected document indicator", "a quote on this line is not closed"},
    Message{"found unexpected end of stream", "a quote on this line is not closed"},
    Message{"found unexpected ':'", "a blank is missing behind a colon on this line"},
    Message{"block sequence entries are not allowed in this context", kItemInside},
    Message{"mapping values are not allowed in this context",
            "a colon can't be here; perhaps this line or the line above lacks a colon or the blank "
            "after it; a map on one line needs braces, {key: value}, and a text with a colon needs "
            "quotes"}};

}  // namespace

std::size_t byteOfColumn(std::string_view line, std::size_t column) {
  std::size_t at = 0;
  for (; column > 0 && at < line.size(); --column)
    at += std::max<std::size_t>(characterAt(line, at).bytes, 1);
  return std::min(at, line.size());
}

YamlEvents::YamlEvents(std::string_view text) : text_(text), parser_(), event_() {
  if (!yaml_parser_initialize(&parser_)) throw std::bad_alloc();
  yaml_parser_set_input_string(&parser_, reinterpret_cast<const unsigned char*>(text.data()),
                               text.size());
}

YamlEvents::~YamlEvents() {
  yaml_event_delete(&event_);
  yaml_parser_delete(&parser_);
}

const yaml_event_t* YamlEvents::next() {
  if (isDone_) return nullptr;
  yaml_event_delete(&event_);
  if (!yaml_parser_parse(&parser_, &event_)) {
    if (parser_.error == YAML_MEMORY_ERROR) throw std::bad_alloc();
    fault_ = explained();
  }
  isDone_ = fault_ || event_.type == YAML_STREAM_END_EVENT;
  return isDone_ ? nullptr : &event_;
}

YamlEvents::Fault YamlEvents::explained() const {
  const std::string problem = parser_.problem ? parser_.problem : "",
                    context = parser_.context ? parser_.context : "";
  if (parser_.error == YAML_READER_ERROR) {
    const std::string_view before = text_.substr(0, parser_.problem_offset);
    return {static_cast<int>(std::count(before.begin(), before.end(), '\n')), problem};
  }
  // A quote that is not closed, or a key without a colon, is reported where it begins; all else
  // where it is found.
  const bool isQuote =
      context == "while scanning a quoted scalar" && problem.starts_with("found unexpected");
  const bool isKey = problem == "could not find expected ':'";
  const yaml_mark_t& mark = isQuote || isKey ? parser_.context_mark : parser_.problem_mark;
  const int line = std::clamp(static_cast<int>(mark.line), 0, linesOf(text_) - 1);
  const std::string_view written = lineOf(text_, line);
  const std::size_t indent = std::min(written.find_first_not_of(" \t"), written.size());
  const std::size_t at = byteOfColumn(written, mark.column);
  const bool isHere = static_cast<std::size_t>(line) == mark.line && at < written.size();
  if (!isQuote && written.substr(0, indent).find('\t') != written.npos)
    return {line, "the line is indented by a tab; use blanks"};
  if (problem == "did not find expected <document start>") {
    if (text_.starts_with('%')) return {line, "--- is missing below the lines that begin with %"};
    if (line > 0 && lineOf(text_, line - 1).starts_with("..."))
      return {line, "nothing may follow the line ..."};
  }
  if (isKey || problem == "did not find expected key" ||
      problem == "did not find expected '-' indicator" ||
      problem == "did not find expected <document start>") {
    if (!isKey && isHere && indent < at) return {line, "nothing may follow the value on this line"};
    return {line,
            "\"key: value\" or \"- value\" is needed here, indented like the lines above it, and "
            "with a blank after the colon or the minus"};
  }
  if (problem == "found character that cannot start any token" && isHere) {
    const char first = written[at];
    if (' ' < first && first < 0x7f)
      return {line, std::string("a text that begins with ") + first + " must be in quotes"};
  }
  if (context == "while scanning an alias" || context == "while scanning an anchor")
    return {line, std::string("a text that begins with ") +
                      (context.ends_with("alias") ? '*' : '&') + " must be in quotes"};
  if (problem == "did not find expected node content") {
    if (!isHere) return {line, "a } or a ] is missing, here or above"};
    return {line, written[at] == '-' ? kItemInside : "a value is missing here"};
  }
  for (const Message& message : kMessages)
    if (message.problem == problem) return {line, message.text};
  return {line, problem + (context.empty() ? "" : " " + context)};
}

}  // namespace corridor
