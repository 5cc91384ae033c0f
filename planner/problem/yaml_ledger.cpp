#include "planner/problem/yaml_ledger.h"

#include <algorithm>
#include <unordered_map>

#include "collision/core/spelling.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {
namespace {

using Use = YamlValue::Entry::Use;

/// Returns whether a value is one that messages of ROS have by default, or consists of such values.
bool isDefault(const YamlValue& value) {
  switch (value.kind) {
    case YamlValue::Kind::Null:
      return true;
    case YamlValue::Kind::Scalar: {
      double number = 1;
      return value.text.empty() || value.text == "false" || value.text == "False" ||
             (parseNumber(value.text, Range::Any, number).empty() && number == 0);
    }
    case YamlValue::Kind::List:
      return std::ranges::all_of(value.items, isDefault);
    case YamlValue::Kind::Map:
      return std::ranges::all_of(value.entries, [](const auto& e) { return isDefault(e.value); });
  }
  return false;
}

class UnreadSearch {
 public:
  explicit UnreadSearch(DefaultValues defaults) : defaults_(defaults) {}

  void visit(const YamlValue& value, const std::string& path) {
    for (const YamlValue& item : value.items) {
      if (item.kind == YamlValue::Kind::Map && !item.isOpened)
        add(path + "[]", item.line, item);
      else
        visit(item, path + "[]");
    }
    for (const YamlValue::Entry& entry : value.entries) {
      if (entry.use == Use::ignored) continue;
      const std::string inner = path.empty() ? entry.key : path + "." + entry.key;
      const bool isClosed = entry.value.kind == YamlValue::Kind::Map && !entry.value.isOpened;
      if (entry.use == Use::unread || isClosed)
        add(inner, entry.line, entry.value);
      else
        visit(entry.value, inner);
    }
  }

  std::vector<UnreadKey> take() { return std::move(found_); }

 private:
  void add(const std::string& path, int line, const YamlValue& value) {
    if (defaults_ == DefaultValues::sayNothing && isDefault(value)) return;
    const auto [known, isNew] = index_.emplace(path, found_.size());
    if (isNew)
      found_.push_back({path, line, 1});
    else
      ++found_[known->second].count;
  }

  DefaultValues defaults_;
  std::vector<UnreadKey> found_;
  std::unordered_map<std::string, std::size_t> index_;  // in `found_`, by path
};

}  // namespace

std::vector<UnreadKey> unreadKeys(const YamlValue& document, DefaultValues defaults) {
  UnreadSearch search(defaults);
  search.visit(document, "");
  return search.take();
}

std::vector<Note> notesOnUnread(const YamlValue& document, const std::string& file,
                                DefaultValues defaults) {
  std::vector<std::string> texts;
  for (const UnreadKey& key : unreadKeys(document, defaults))
    texts.push_back(key.path + " (line " + std::to_string(key.line) +
                    (key.count == 1 ? ")" : ", and " + std::to_string(key.count - 1) + " more)"));
  if (texts.empty()) return {};
  constexpr std::size_t kShown = 12;
  return {{file + ": not used: " + joinedFirst(texts, kShown), NoteWeight::motion}};
}

void markRead(const YamlValue& value) {
  value.isOpened = true;
  for (const YamlValue& item : value.items) markRead(item);
  for (const YamlValue::Entry& entry : value.entries) {
    entry.use = Use::read;
    markRead(entry.value);
  }
}

}  // namespace corridor
