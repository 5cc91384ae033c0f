#include "collision/core/spelling.h"

#include <algorithm>
#include <cctype>
#include <charconv>

#include "collision/core/text_encoding.h"

namespace corridor {

std::string lowered(std::string_view word) {
  std::string text(word);
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

std::string percentDecoded(std::string_view text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned char byte = 0;
    const char* const digits = text.data() + i + 1;
    if (text[i] == '%' && i + 2 < text.size() &&
        std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2 && byte != 0) {
      decoded += static_cast<char>(byte);
      i += 2;
    } else {
      decoded += text[i];
    }
  }
  return decoded;
}

std::size_t editDistance(std::string_view a, std::string_view b) {
  // `before`, `last` and `row` are the rows i − 2, i − 1 and i of the table of distances between
  // prefixes.
  std::vector<std::size_t> before, last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before = last;
    last = row;
  }
  return last[b.size()];
}

std::optional<std::string> mostSimilar(std::string_view word,
                                       const std::vector<std::string>& candidates) {
  constexpr std::size_t longest = 100;  // longer than any key; limits the time for hostile files
  if (word.size() > longest) return std::nullopt;
  std::optional<std::string> best;
  std::size_t bestDistance = 0;
  for (const std::string& candidate : candidates) {
    const std::size_t longer = std::max(word.size(), candidate.size());
    const std::size_t limit = std::max<std::size_t>(1, longer / 3);
    if (longer - std::min(word.size(), candidate.size()) > limit) continue;
    const std::size_t distance = editDistance(lowered(word), lowered(candidate));
    if (distance <= limit && distance < word.size() && (!best || distance < bestDistance)) {
      best = candidate;
      bestDistance = distance;
    }
  }
  return best;
}

std::string didYouMean(std::string_view word, const std::vector<std::string>& candidates) {
  const auto near = mostSimilar(word, candidates);
  return near ? " (did you mean \"" + *near + "\"?)" : "";
}

std::string knownWords(const std::vector<std::string>& words) {
  return words.empty() ? "" : " (known: " + joinedFirst(words) + ")";
}

std::string joinedFirst(const std::vector<std::string>& words, std::size_t most) {
  if (words.size() <= most) return joined(words);
  const std::vector<std::string> first(words.begin(),
                                       words.begin() + static_cast<std::ptrdiff_t>(most));
  return joined(first) + " and " + std::to_string(words.size() - most) + " more";
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::string notOneOf(std::string_view word, const std::vector<std::string>& words) {
  return "one of " + joined(words) + " is needed, not " + quotedWord(word) +
         didYouMean(word, words);
}

std::string withoutControls(std::string text) {
  const auto isControl = [](char32_t c) {
    return c < ' ' || (c >= 0x7F && c < 0xA0) || c == 0x061C || c == 0x200E || c == 0x200F ||
           (c >= 0x2028 && c <= 0x202E) || (c >= 0x2066 && c <= 0x2069);
  };
  std::string shown;
  for (std::size_t at = 0; at < text.size();) {
    const auto [number, bytes] = characterAt(text, at);
    if (bytes == 0 || isControl(number))
      shown += '?';
    else
      shown.append(text, at, bytes);
    at += std::max<std::size_t>(bytes, 1);
  }
  return shown;
}

std::string quotedWord(std::string_view word) {
  constexpr std::size_t longest = 60;
  std::size_t end = std::min(word.size(), longest);
  while (end < word.size() && end > 0 && (word[end] & 0xC0) == 0x80)
    --end;  // never cut inside a UTF-8 character
  return '"' + withoutControls(std::string(word.substr(0, end))) +
         (end < word.size() ? "…\"" : "\"");
}

std::string quotedPath(std::string_view path) {
  constexpr std::size_t longest = 60;
  if (path.size() <= longest) return quotedWord(path);
  std::size_t begin = path.size() - longest;
  while (begin < path.size() && (path[begin] & 0xC0) == 0x80)
    ++begin;  // never cut inside a UTF-8 character
  std::size_t slash = path.find('/', begin);
  while (slash != path.npos && path.substr(slash + 1).starts_with('/')) ++slash;
  if (slash != path.npos && slash + 1 < path.size()) begin = slash;
  return "\"…" + quotedWord(path.substr(begin)).substr(1);
}

}  // namespace corridor
