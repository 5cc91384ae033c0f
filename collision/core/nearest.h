#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace corridor {

/// How many letters must be inserted, removed, replaced or swapped with their neighbour to turn `a`
/// into `b` (optimal string alignment).
std::size_t editDistance(std::string_view a, std::string_view b);

/// The candidate that a user may have meant: the first of those with the least distance, capitals
/// and small letters alike, if it takes at most a third of the longer word's letters (but always
/// one change, of a word of more letters).
std::optional<std::string> nearest(std::string_view word,
                                   const std::vector<std::string>& candidates);

/// `; did you mean "…"?` or nothing.
std::string didYouMean(std::string_view word, const std::vector<std::string>& candidates);

/// ` (known: a, b, c)`, as `joinedFirst`.
std::string knownWords(const std::vector<std::string>& words);

/// "a, b, c"; of many the first few: "a, b, c and 970 more".
std::string joinedFirst(const std::vector<std::string>& words);

/// "a, b, c"
std::string joined(const std::vector<std::string>& words);

/// For messages: in double quotes, shortened, control characters shown as '?'.
std::string quotedWord(std::string_view word);

}  // namespace corridor
