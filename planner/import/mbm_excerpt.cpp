#include "planner/import/mbm_excerpt.h"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace corridor {
namespace {

/// The place of a problem in a set, that of its entry `"index": …`, and the text of its index.
struct ProblemText {
  std::size_t begin = 0, end = 0;
  std::size_t keyBegin = 0, valueEnd = 0;
  std::string_view index;
};

/// Finds the problems in a set. Skips what it does not need by matching brackets and quotes only.
class SetScanner {
 public:
  explicit SetScanner(std::string_view text) : text_(text) {}

  /// Returns the problems, or nullopt if the text is not laid out as a set.
  std::optional<std::vector<ProblemText>> problems() {
    const bool isSound = object([&](std::string_view key) {
      if (key != "problems") return skipValue();
      return !std::exchange(found_, true) && list([&] { return problem(); });
    });
    if (!isSound || !found_) return std::nullopt;
    return std::move(problems_);
  }

 private:
  bool problem() {
    ProblemText problem;
    problem.begin = at_;
    const bool isSound = object([&](std::string_view key) {
      const std::size_t begin = at_;
      if (!skipValue()) return false;
      if (key != "index") return true;
      const bool isFirst = problem.index.empty();
      problem.keyBegin = static_cast<std::size_t>(key.data() - text_.data()) - 1;
      problem.valueEnd = at_;
      problem.index = text_.substr(begin, at_ - begin);
      return isFirst;
    });
    problem.end = at_;
    problems_.push_back(problem);
    return isSound && !problem.index.empty() && problem.index.size() < 19 &&
           problem.index.find_first_not_of("0123456789") == problem.index.npos;
  }

  /// Reads an object. Calls `read(key)` at each value; stops if it returns false.
  template <class Read>
  bool object(const Read& read) {
    return list('{', '}', [&] {
      const auto key = word();
      if (!key || !take(':')) return false;
      skipBlanks();
      return read(*key);
    });
  }
  template <class Read>
  bool list(const Read& read) {
    return list('[', ']', read);
  }
  template <class Read>
  bool list(char open, char close, const Read& read) {
    if (!take(open)) return false;
    if (take(close)) return true;
    do {
      skipBlanks();
      if (!read()) return false;
    } while (take(','));
    return take(close);
  }

  /// Returns the text between two quotes, or nullopt if there is none here.
  std::optional<std::string_view> word() {
    if (!take('"')) return std::nullopt;
    const std::size_t begin = at_;
    for (; at_ < text_.size(); ++at_) {
      if (text_[at_] == '\\')
        ++at_;
      else if (text_[at_] == '"')
        return text_.substr(begin, at_++ - begin);
    }
    return std::nullopt;
  }
  bool skipValue() {
    int depth = 0;
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '"') {
        if (!word()) return false;
      } else if (c == '{' || c == '[') {
        ++depth, ++at_;
      } else if (c == '}' || c == ']') {
        if (depth == 0) return false;
        --depth, ++at_;
      } else if (depth > 0) {
        skipToBracketOrQuote();
      } else {
        at_ = text_.find_first_of(",]} \t\r\n", at_);
        if (at_ == text_.npos) return false;
      }
      if (depth == 0) return true;
    }
    return false;
  }
  /// `find_first_of` takes three times as long, and most of the text is skipped here.
  void skipToBracketOrQuote() {
    const auto isSought = [](char c) {
      return c == '"' || c == '{' || c == '}' || c == '[' || c == ']';
    };
    while (at_ < text_.size() && !isSought(text_[at_])) ++at_;
  }
  void skipBlanks() { at_ = std::min(text_.find_first_not_of(" \t\r\n", at_), text_.size()); }
  bool take(char c) {
    skipBlanks();
    if (at_ == text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  bool found_ = false;
  std::vector<ProblemText> problems_;
};

}  // namespace

std::string excerptOfSet(std::string text, const std::string& index) {
  const auto problems = SetScanner(text).problems();
  if (!problems) return text;
  std::string excerpt;
  std::size_t taken = 0;
  for (const ProblemText& problem : *problems) {
    if (problem.index == index) continue;
    // Takes the text up to `begin`, and of the text up to `end` the line ends only.
    const auto leaveOut = [&](std::size_t begin, std::size_t end) {
      excerpt.append(text, taken, begin - taken);
      excerpt.append(static_cast<std::size_t>(std::count(text.begin() + std::ptrdiff_t(begin),
                                                         text.begin() + std::ptrdiff_t(end), '\n')),
                     '\n');
      taken = end;
    };
    leaveOut(problem.begin + 1, problem.keyBegin);
    leaveOut(problem.valueEnd, problem.end - 1);
  }
  excerpt.append(text, taken);
  return excerpt;
}

}  // namespace corridor
