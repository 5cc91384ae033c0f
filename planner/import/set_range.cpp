#include "planner/import/set_range.h"

#include <charconv>
#include <optional>

#include "collision/core/error.h"
#include "collision/core/spelling.h"

namespace corridor {
namespace {

constexpr std::size_t kMostOfARange = 1000;

/// Reads a whole number of one to nine digits, and nothing else; nullopt for any other text.
std::optional<std::size_t> problemNumber(const std::string& digits) {
  std::size_t number = 0;
  const char* const end = digits.data() + digits.size();
  if (digits.empty() || digits.size() > 9) return std::nullopt;
  const auto [stop, error] = std::from_chars(digits.data(), end, number);
  return error == std::errc{} && stop == end ? std::optional(number) : std::nullopt;
}

}  // namespace

std::vector<std::string> problemsOf(const std::string& text) {
  const auto hash = text.rfind('#'), dash = text.find('-', hash);
  if (hash == text.npos || dash == text.npos) return {text};
  const std::string file = text.substr(0, hash);
  const auto first = problemNumber(text.substr(hash + 1, dash - hash - 1)),
             last = problemNumber(text.substr(dash + 1));
  if (!first || !last) return {text};
  if (*last < *first || *last - *first >= kMostOfARange)
    throw InputError(Fault{file, 0,
                           quotedWord(text.substr(hash)) + " is not a range of 1 to " +
                               std::to_string(kMostOfARange) + " problems, such as #1-10"});
  std::vector<std::string> problems;
  for (std::size_t i = *first; i <= *last; ++i) problems.push_back(file + "#" + std::to_string(i));
  return problems;
}

}  // namespace corridor
