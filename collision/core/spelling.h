#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace corridor {

/// Returns the word with its ASCII letters in lower case.
std::string lowered(std::string_view word);

/// Returns the least number of edits that turn `a` into `b`. An edit inserts, removes or replaces a
/// byte, or swaps two neighbouring bytes (optimal string alignment).
std::size_t editDistance(std::string_view a, std::string_view b);

/// Returns the candidate that a user may have meant: the first with the least edit distance,
/// ignoring case. The distance must be at most 1 or at most a third of the longer word's length,
/// and less than the length of `word`. Words of more than 100 bytes get no suggestion.
std::optional<std::string> mostSimilar(std::string_view word,
                                       const std::vector<std::string>& candidates);

/// Returns ` (did you mean "…"?)` with the most similar candidate, or "" if no candidate is
/// similar. The text can be appended to a message, or stand within the message.
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

/// Returns the word for a message: in double quotes, with control characters as '?'. A word of more
/// than 60 bytes is cut after at most 60 bytes, and "…" marks the cut.
std::string quotedWord(std::string_view word);

/// Returns the name of a file for a message, like `quotedWord`. If the name has more than 60 bytes,
/// its beginning is cut off, at a slash if possible: "…/collision/link5.stl".
std::string quotedPath(std::string_view path);

}  // namespace corridor
