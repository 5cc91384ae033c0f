#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace corridor {

/// Returns the word with its ASCII letters in lower case.
std::string lowered(std::string_view word);
/// Returns a text with the bytes that URIs write as %20 and the like. Other uses of % are kept.
std::string percentDecoded(std::string_view text);

/// Returns the least number of edits that turn `a` into `b`. An edit inserts, removes or replaces a
/// byte, or swaps two neighbouring bytes (optimal string alignment).
std::size_t editDistance(std::string_view a, std::string_view b);

/// Returns the candidate that a user may have meant: the first candidate with the least edit
/// distance from `word`. Upper and lower case count as equal. The distance must be less than the
/// length of `word`, and at most max(1, n/3), where n is the length of the longer of `word` and the
/// candidate. Returns nullopt if no candidate qualifies, or if `word` has more than 100 bytes.
std::optional<std::string> mostSimilar(std::string_view word,
                                       const std::vector<std::string>& candidates);

/// Returns ` (did you mean "…"?)` with the candidate of `mostSimilar`, or "" if there is none. The
/// text may stand at the end of a message, or within it.
std::string didYouMean(std::string_view word, const std::vector<std::string>& candidates);

/// Returns ` (known: a, b, c)`, with at most 30 words (`joinedFirst`), or "" if there is no word.
std::string knownWords(const std::vector<std::string>& words);

/// Returns "a, b, c" if there are at most `most` words. Otherwise returns the first `most` words
/// and the number of the others: "a, b, c and 970 more".
std::string joinedFirst(const std::vector<std::string>& words, std::size_t most = 30);

/// Returns all words: "a, b, c".
std::string joined(const std::vector<std::string>& words);

/// Returns `one of a, b is needed, not "c"` for the words a and b, followed by the suggestion of
/// `didYouMean`.
std::string notOneOf(std::string_view word, const std::vector<std::string>& words);

/// Returns the text with '?' in place of each byte that is not UTF-8, and of each character that
/// controls a terminal or a line: control characters of ASCII and of Latin-1, line and paragraph
/// separators, and those that change the direction of text. Names and texts in files may contain
/// them.
std::string withoutControls(std::string text);

/// Returns the word for a message: in double quotes, with control characters as '?'. A word of more
/// than 60 bytes is cut after at most 60 bytes, and "…" marks the cut.
std::string quotedWord(std::string_view word);

/// Returns the name of a file for a message, like `quotedWord`. If the name has more than 60 bytes,
/// its beginning is cut off, at a slash if possible: "…/collision/link5.stl".
std::string quotedPath(std::string_view path);

}  // namespace corridor
