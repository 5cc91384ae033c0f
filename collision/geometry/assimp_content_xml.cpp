#include "collision/geometry/assimp_content_xml.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <utility>

#include "collision/core/spelling.h"

namespace corridor {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";

}  // namespace

XmlTag xmlTagAt(std::string_view text, std::size_t at) {
  XmlTag tag;
  tag.from = at;
  std::size_t end = at + 1;
  for (char quote = 0; end < text.size() && (quote || text[end] != '>'); ++end) {
    const char c = text[end];
    if (quote ? c == quote : c == '"' || c == '\'') quote = quote ? '\0' : c;
  }
  tag.to = std::min(end + 1, text.size());
  std::string_view inside = text.substr(at + 1, end - at - 1);
  tag.isEnd = inside.starts_with('/');
  if (tag.isEnd) inside.remove_prefix(1);
  tag.isEmpty = inside.ends_with('/');
  if (tag.isEmpty) inside.remove_suffix(1);
  tag.name = inside.substr(0, inside.find_first_of(kBlanks));
  tag.attributes = inside.substr(tag.name.size());
  return tag;
}

bool isListed(std::string_view list, std::string_view name) {
  for (auto at = list.find(name); at != list.npos; at = list.find(name, at + 1)) {
    const auto end = at + name.size();
    if (at > 0 && list[at - 1] == ' ' && end < list.size() && list[end] == ' ') return true;
  }
  return false;
}

std::string_view withoutBlanks(std::string_view text) {
  const auto first = std::min(text.find_first_not_of(kBlanks), text.size());
  return text.substr(first, text.find_last_not_of(kBlanks) + 1 - first);
}

std::string_view takeWord(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(kBlanks));
  text.remove_prefix(word.size());
  return word;
}

double numberIn(std::string_view text) {
  text = withoutBlanks(text);
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  double value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool isNumber = error == std::errc() && stop == text.data() + text.size();
  return isNumber && std::isfinite(value) ? value : std::nan("");
}

std::vector<double> numbersIn(std::string_view text) {
  std::vector<double> numbers;
  for (std::string_view word = takeWord(text); !word.empty(); word = takeWord(text))
    numbers.push_back(numberIn(word));
  return numbers;
}

long wholeNumberIn(std::string_view text) {
  text = withoutBlanks(text);
  std::int32_t value = -1;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && stop == text.data() + text.size() && value >= 0 ? value : -1;
}

namespace {

struct Attribute {
  std::string_view name, value;
};

/// Returns the next attribute of a text, and removes it; nullopt if there is none.
std::optional<Attribute> takeAttribute(std::string_view& rest) {
  const auto equals = rest.find('=');
  const auto quote = rest.find_first_of("\"'", equals);
  if (equals == rest.npos || quote == rest.npos) return std::nullopt;
  const auto end = std::min(rest.find(rest[quote], quote + 1), rest.size());
  const Attribute attribute{withoutBlanks(rest.substr(0, equals)),
                            rest.substr(quote + 1, end - quote - 1)};
  rest.remove_prefix(std::min(end + 1, rest.size()));
  return attribute;
}

}  // namespace

std::optional<std::string_view> XmlTag::find(std::string_view attribute) const {
  for (std::string_view rest = attributes; const auto next = takeAttribute(rest);)
    if (next->name == attribute) return next->value;
  return std::nullopt;
}

std::optional<std::string_view> XmlTag::findInOtherCase(std::string_view attribute) const {
  for (std::string_view rest = attributes; const auto next = takeAttribute(rest);)
    if (next->name.size() == attribute.size() && next->name != attribute &&
        lowered(next->name) == lowered(attribute))
      return next->name;
  return std::nullopt;
}

std::vector<std::string_view> XmlTag::names() const {
  std::vector<std::string_view> names;
  for (std::string_view rest = attributes; const auto next = takeAttribute(rest);)
    names.push_back(next->name);
  return names;
}

bool XmlCheck::isAccepted(std::string_view name) const {
  return (rules_.accepted.empty() || isListed(rules_.accepted, name)) &&
         !isListed(rules_.refused, name);
}

void XmlCheck::run() {
  const std::string second = "; the file needs one root, <" + std::string(rules_.root) + ">";
  bool isFirst = true;
  while (auto tag = next()) {
    if (tag->isEnd) {
      if (open_.empty() || open_.back().name != tag->name) return malformed();
      open_.back().content = text_.substr(open_.back().to, tag->from - open_.back().to);
      finish();
      continue;
    }
    if (isFirst && tag->name != rules_.root) {
      // assimp may find the root behind it.
      if (text_.find('<' + std::string(rules_.root), tag->to) == text_.npos) return malformed();
      return fault(tag->line, "<" + std::string(tag->name) + "> is the root" + second);
    }
    if (!isFirst && open_.empty())
      return fault(tag->line, "<" + std::string(tag->name) + "> is a second root" + second);
    isFirst = false;
    if (!open_.empty()) open_.back().isEmpty = false;
    const bool isEmpty = std::exchange(tag->isEmpty, true);  // until a child comes
    start(std::move(*tag));
    if (isEmpty) finish();
  }
  if (isFirst || !open_.empty()) malformed();
  end();
}

void XmlCheck::start(XmlTag tag) {
  const std::string name(tag.name);
  if (open_.size() <= refused_) refused_ = kNone;
  if (refused_ == kNone) {  // not within an element that is refused
    const std::string_view parent = around(0);
    if (!isAccepted(name) || (rules_.places.find(' ' + name + '/') != std::string_view::npos &&
                              !isListed(rules_.places, name + '/' + std::string(parent)))) {
      fault(
          tag.line,
          "<" + name + "> may be or move geometry, and assimp does not read it rightly" + kInstead);
      refused_ = open_.size();
    }
    if (!open_.empty() && isListed(rules_.single, name)) {
      std::string& single = open_.back().single;
      if (isListed(single, name))
        fault(tag.line, "a second <" + name + "> is in one <" + std::string(parent) +
                            ">, and assimp drops one" + kInstead);
      single += ' ' + name + ' ';
    }
    if (isListed(rules_.numbered, name)) requireOwnId(tag);
    checkTwice(tag);
    enter(tag);
  }
  open_.push_back(std::move(tag));
}

void XmlCheck::finish() {
  if (open_.size() <= refused_) leave(open_.back());
  open_.pop_back();
}

void XmlCheck::checkCase(const XmlTag& tag, std::initializer_list<std::string_view> names) {
  for (const std::string_view name : names)
    if (const auto other = tag.findInOtherCase(name))
      fault(tag.line, "the attribute \"" + std::string(*other) + "\" of <" + std::string(tag.name) +
                          "> is not read; write \"" + std::string(name) + '"');
}

void XmlCheck::checkTwice(const XmlTag& tag) {
  const std::vector<std::string_view> names = tag.names();
  for (auto name = names.begin(); name != names.end(); ++name)
    if (std::find(names.begin(), name, *name) != name)
      fault(tag.line, "<" + std::string(tag.name) + "> has the attribute \"" + std::string(*name) +
                          "\" twice; keep one");
}

void XmlCheck::requireOwnId(const XmlTag& tag) {
  const std::string name(tag.name), id(tag.value("id"));
  if (!ids_.insert(name + ' ' + id).second)
    fault(tag.line, "two elements <" + name + "> have the id \"" + id +
                        "\", so assimp drops one; give each an id of its own");
}

/// Returns the next tag. Text, comments and the like are skipped.
std::optional<XmlTag> XmlCheck::next() {
  while (true) {
    const std::size_t at = at_ = text_.find('<', at_);
    if (at == text_.npos) return std::nullopt;
    line_ += static_cast<int>(
        std::count(text_.begin() + std::exchange(counted_, at), text_.begin() + at, '\n'));
    const std::string_view rest = text_.substr(at);
    if (rest.starts_with("<!--")) {
      at_ = at + 4;
      skipTo("-->");
    } else if (rest.starts_with("<![CDATA[")) {
      skipTo("]]>");
    } else if (rest.starts_with("<?")) {
      skipTo("?>");
    } else if (rest.starts_with("<!")) {
      // It ends at the first > that is not in quotes. pugixml takes comments and the like within
      // it.
      at_ = xmlTagAt(text_, at).to;
      const std::string_view declaration = text_.substr(at + 1, at_ - at - 1);
      if (!declaration.starts_with("!DOCTYPE") ||
          declaration.find_first_of("[<") != declaration.npos)
        fault(line_, "a DOCTYPE with declarations is not read; save the file without it");
    } else {
      XmlTag tag = xmlTagAt(text_, at);
      tag.line = line_;
      at_ = tag.to;
      return tag;
    }
  }
}

void XmlCheck::skipTo(std::string_view end) {
  const auto found = text_.find(end, at_);
  at_ = found == text_.npos ? found : found + end.size();
}

}  // namespace corridor
