#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace corridor {

/// Returns the word with its ASCII letters in lower case.
std::string lowered(std::string_view word);

/// Returns how many bytes must be inserted, removed, replaced, or swapped with their neighbour to
/// turn `a` into `b` (optimal string alignment).
std::size_t editDistance(std::string_view a, std::string_view b);

/// Returns the candidate that a user may have meant: the first with the least edit distance,
/// ignoring case. The distance must be at most 1 or at most a third of the longer word's length,
/// and less than the length of `word`. Words of more than 100 bytes get no suggestion.
std::optional<std::string> mostSimilar(std::string_view word,
                                       const std::vector<std::string>& candidates);

/// Returns ` (did you mean "…"?)` with the most similar candidate, or "". The text can be appended
/// to a message, or stand within it.
std::string didYouMean(std::string_view word, const std::vector<std::string>& candidates);

/// Returns ` (known: a, b, c)`, with at most 30 words (`joinedFirst`), or "" if there is no word.
std::string knownWords(const std::vector<std::string>& words);

/// Returns "a, b, c", or the first `most` words and the number of the others: "a, b, c and 970
/// more".
std::string joinedFirst(const std::vector<std::string>& words, std::size_t most = 30);

/// Returns all words: "a, b, c".
std::string joined(const std::vector<std::string>& words);

/// Returns `one of a, b is needed, not "c"`, followed by the suggestion of `didYouMean`.
std::string notOneOf(std::string_view word, const std::vector<std::string>& words);

/// Returns the word for a message: in double quotes, at most 60 bytes, control characters as '?'.
std::string quotedWord(std::string_view word);

/// Returns the name of a file for a message, as quotedWord(). A longer name is cut at its begin, at
/// a slash if possible: "…/collision/link5.stl".
std::string quotedPath(std::string_view path);

}  // namespace corridor
