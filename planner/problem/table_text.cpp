#include "planner/problem/table_text.h"

#include <algorithm>
#include <cctype>
#include <string_view>

#include "collision/core/spelling.h"
#include "planner/problem/text_words.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {

std::string wrongFields(const std::string& line, bool isFirst,
                        const std::vector<std::string>& names) {
  int commas = 0;
  bool isEmpty = true;
  for (const char c : line) {
    if (c == '#') break;
    if (c == ',') {
      ++commas;
      if (isEmpty)
        return "the field before comma " + std::to_string(commas) + " is empty" +
               (isFirst && commas == 1 ? " (pandas writes its index so; use index=False)" : "");
      isEmpty = true;
    } else if (c != ' ' && c != '\t' && c != '\r') {
      isEmpty = false;
    }
  }
  if (!isFirst || names.empty()) return "";
  std::vector<std::string> words = wordsOfLine(line), sorted = names;
  std::sort(words.begin(), words.end());
  std::sort(sorted.begin(), sorted.end());
  double value = 0;
  const auto isNumber = [&](const std::string& word) {
    return parseNumber(word, Range::Any, value).empty();
  };
  if (words != sorted || !std::all_of(words.begin(), words.end(), isNumber)) return "";
  return "the names of all columns are numbers, so this may be a header or a row; for a row, write "
         "decimal points: 1.0";
}

namespace {

/// Returns whether a text mentions names as a header would (see resemblesHeader). All words are in
/// lower case.
bool mentionsAsHeader(const std::string& text, const std::vector<std::string>& names) {
  const auto isLetter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; };
  const auto isPart = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; };
  // The places in `text` that a name covers.
  std::vector<bool> covered(text.size(), false);
  std::size_t mentioned = 0;
  for (const std::string& name : names) {
    bool found = false;
    for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + 1)) {
      const std::size_t end = at + name.size();
      if ((at > 0 && isPart(text[at - 1])) || (end < text.size() && isPart(text[end]))) continue;
      found = true;
      std::fill(covered.begin() + std::ptrdiff_t(at), covered.begin() + std::ptrdiff_t(end), true);
    }
    mentioned += found;
  }
  std::size_t words = 0, named = 0;
  for (std::size_t i = 0; i < text.size();) {
    bool hasLetter = false, hasName = false;
    for (; i < text.size() && (covered[i] || isPart(text[i]) || text[i] == '_'); ++i)
      hasLetter |= isLetter(text[i]), hasName |= covered[i];
    words += hasLetter || hasName;
    named += hasName;
    if (i < text.size() && !covered[i]) ++i;
  }
  return (2 * mentioned >= names.size() && named > 0 && 2 * named >= words) ||
         (mentioned >= 3 && mentioned == names.size());
}

/// Returns the word in lower case, without the marks by which programs write an index: q[2], q_2.
std::string withoutMarks(const std::string& word) {
  std::string text = lowered(word);
  std::erase_if(text, [](char c) {
    return std::string_view("[]{}()_-./").find(c) != std::string_view::npos;
  });
  return text;
}

}  // namespace

bool resemblesHeader(const std::string& comment, const std::vector<std::string>& names) {
  if (wordsOfLine(comment) == names) return false;
  std::vector<std::string> lower, bare, last;
  for (const std::string& name : names) {
    lower.push_back(lowered(name));
    bare.push_back(withoutMarks(name));
    last.push_back(lower.back().substr(lower.back().rfind('/') + 1));
  }
  const std::string text = lowered(comment);
  return mentionsAsHeader(text, lower) || mentionsAsHeader(text, last) ||
         mentionsAsHeader(withoutMarks(comment), bare);
}

std::string resemblesHeaderText(const std::vector<std::string>& names) {
  std::string header;
  for (const std::string& name : names) header += (header.empty() ? "" : ",") + name;
  return "the comment seems to be a header, but is not one; write the names only, as in \"" +
         header + "\" (rad, m), or move the comment behind the first row";
}

bool hasLetters(const std::string& comment) {
  return std::any_of(comment.begin(), comment.end(),
                     [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; });
}

std::string notReadText(int line, const std::vector<std::string>& columns) {
  return "line " + std::to_string(line) + " is a comment, which is not read; the columns are " +
         joinedFirst(columns) + ", in this order, in m and rad";
}

}  // namespace corridor
