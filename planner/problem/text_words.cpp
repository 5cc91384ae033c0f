#include "planner/problem/text_words.h"

#include <algorithm>
#include <cctype>

#include "collision/core/error.h"
#include "collision/core/spelling.h"
#include "collision/core/text_encoding.h"

namespace corridor {

namespace {

bool isBetweenWords(char c) {
  return c == ',' || c == ' ' || (c >= '\t' && c <= '\r');
}

/// Returns the end of the word in quotes that begins at `at`: the index behind its last quote. Sets
/// `word`. Returns npos if the quote is not closed before a separator, a comment or the end.
std::size_t endOfQuoted(std::string_view line, std::size_t at, std::string& word) {
  word.clear();
  for (std::size_t i = at + 1; i < line.size(); ++i) {
    if (line[i] != '"') {
      word += line[i];
    } else if (i + 1 < line.size() && line[i + 1] == '"') {
      word += line[i++];
    } else {
      const bool isEnd = i + 1 == line.size() || isBetweenWords(line[i + 1]) || line[i + 1] == '#';
      return isEnd && !word.empty() ? i + 1 : std::string_view::npos;
    }
  }
  return std::string_view::npos;
}

/// Calls take(word) for each word of a line. Returns the index of its comment; npos without one.
template <class Take>
std::size_t forWords(std::string_view line, const Take& take) {
  std::string word;
  for (std::size_t i = 0; i < line.size();) {
    if (line[i] == '#') return i;
    if (isBetweenWords(line[i])) {
      ++i;
    } else if (const std::size_t end =
                   line[i] == '"' ? endOfQuoted(line, i, word) : std::string_view::npos;
               end != std::string_view::npos) {
      take(word);
      i = end;
    } else {
      const std::size_t begin = i;
      while (i < line.size() && line[i] != '#' && !isBetweenWords(line[i])) ++i;
      take(std::string(line.substr(begin, i - begin)));
    }
  }
  return std::string_view::npos;
}

}  // namespace

std::vector<std::string> wordsOfLine(std::string_view line) {
  std::vector<std::string> all;
  forWords(line, [&](const std::string& word) { all.push_back(word); });
  return all;
}

std::size_t commentStart(std::string_view line) {
  return forWords(line, [](const std::string&) {});
}

std::string yamlWord(const std::string& text) {
  const auto isPlain = [](unsigned char c) {
    return std::isalnum(c) || c == '_' || c == '.' || c == '/' || c == '-';
  };
  static const std::vector<std::string> reserved = {"true", "false", "yes", "no", "on",
                                                    "off",  "null",  "y",   "n"};
  const unsigned char first = text.empty() ? '\0' : static_cast<unsigned char>(text[0]);
  if ((std::isalpha(first) || first == '_' || (first == '.' && text.starts_with("../"))) &&
      std::all_of(text.begin(), text.end(), isPlain) &&
      std::find(reserved.begin(), reserved.end(), lowered(text)) == reserved.end())
    return text;
  if (firstBeyondUtf8(text) != text.npos)
    throw InputError(
        Fault{text, 0, "this name is not in UTF-8, and YAML has no other; rename the file"});
  return yamlText(text);
}

std::string yamlText(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if ((c >= 0 && c < ' ') || c == 0x7f) {
      constexpr const char* digits = "0123456789abcdef";
      quoted += std::string("\\x") + digits[c / 16] + digits[c % 16];
      continue;
    }
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "\"";
}

}  // namespace corridor
