#include "planner/problem/table_lines.h"

#include <algorithm>
#include <cctype>
#include <initializer_list>
#include <string_view>
#include <utility>

#include "collision/core/error.h"
#include "collision/core/read_file.h"
#include "collision/core/spelling.h"
#include "collision/core/text_encoding.h"
#include "collision/geometry/column_names.h"
#include "planner/problem/text_words.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {
namespace {

using Words = std::vector<std::string>;

bool isNumber(const std::string& word) {
  double value = 0;
  return parseNumber(word, Range::Any, value).empty();
}

bool hasLetters(const std::string& text) {
  return std::any_of(text.begin(), text.end(),
                     [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; });
}

/// Returns the number of the first comma of a line with nothing but blanks before it, or 0.
int commaAfterNothing(const std::string& line) {
  int commas = 0;
  bool isEmpty = true, isQuoted = false;
  for (const char c : line.substr(0, commentStart(line))) {
    if (c == '"') isQuoted = !isQuoted;
    if (isQuoted) isEmpty = false;
    if (isQuoted) continue;
    if (c == ',') {
      ++commas;
      if (isEmpty) return commas;
      isEmpty = true;
    } else if (c != ' ' && c != '\t' && c != '\r') {
      isEmpty = false;
    }
  }
  return 0;
}

/// Returns whether the words are the columns, or a part of them that the columns repeat: the names
/// of one state above a file of edges.
bool repeats(const Words& columns, const Words& words) {
  if (words.empty() || columns.size() % words.size() != 0) return false;
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (columns[i] != words[i % words.size()]) return false;
  return true;
}

/// A word of a comment, in lower case, and the mark before it: ' ' if there is none.
struct CommentWord {
  std::string text;
  char mark = ' ';
};

std::vector<CommentWord> wordsOfComment(const std::string& comment) {
  const std::string text = lowered(comment);
  const auto isPart = [](char c) {  // "\u00b0" has bytes from 0x80
    return std::isalpha(static_cast<unsigned char>(c)) != 0 ||
           static_cast<unsigned char>(c) >= 0x80;
  };
  std::vector<CommentWord> words;
  CommentWord word;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (!isPart(text[at])) {
      if (text[at] != ' ' && text[at] != '\t') word.mark = text[at];
      continue;
    }
    word.text += text[at];
    if (at + 1 < text.size() && isPart(text[at + 1])) continue;
    words.push_back(std::exchange(word, {}));
  }
  return words;
}

bool isIn(const std::string& word, std::initializer_list<std::string_view> words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

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

std::string otherUnit(const std::string& comment) {
  const auto isOther = [](const std::string& word) {
    const double metres = metresOfUnit(word);
    return (metres > 0 && metres != 1) ||
           isIn(word, {"deg", "degs", "degree", "degrees", "\u00b0", "mrad", "milliradians", "ms",
                       "msec", "milliseconds", "us", "microseconds", "ns", "nanoseconds"});
  };
  const auto isOwn = [](const std::string& word) {
    return metresOfUnit(word) == 1 ||
           isIn(word, {"rad", "radian", "radians", "s", "sec", "second", "seconds"});
  };
  const std::vector<CommentWord> words = wordsOfComment(comment);
  const bool hasOnlyUnits = std::all_of(words.begin(), words.end(), [&](const CommentWord& word) {
    return isOther(word.text) || isOwn(word.text);
  });
  bool isOnUnits = hasOnlyUnits;  // or behind "units:"
  bool follows = false;           // "in rad and": a unit may follow
  for (std::size_t i = 0; i < words.size(); ++i) {
    const auto& [word, mark] = words[i];
    const std::string before = i > 0 ? words[i - 1].text : "";
    // "units: rad, mm; …": a number before a unit, or a ";", ends the list.
    if (word == "unit" || word == "units")
      isOnUnits = true;
    else if (mark == ';' || std::isdigit(static_cast<unsigned char>(mark)) != 0)
      isOnUnits = follows = false;
    const bool isAfterIn = before == "in" && mark == ' ' && !(i > 1 && words[i - 2].text == "not");
    const bool isClear = isOnUnits || isAfterIn || follows ||
                         std::string_view("[(:=").find(mark) != std::string::npos;
    if (isClear && isOther(word)) return word;
    follows = (isClear && isOwn(word)) || (follows && (word == "and" || word == "or"));
  }
  return "";
}

bool resemblesHeader(const std::string& comment, const std::vector<std::string>& names) {
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

TableLines::TableLines(std::string file, const std::string& text, std::vector<std::string> columns,
                       std::function<bool(const std::string&)> isName)
    : file_(std::move(file)),
      lines_(withLineFeeds(text)),
      columns_(std::move(columns)),
      isName_(std::move(isName)) {}

bool TableLines::next() {
  isHeader_ = false;
  while (std::getline(lines_, line_)) {
    ++number_;
    if (number_ == 1) line_ = withoutByteOrderMark(line_);
    const std::size_t mark = commentStart(line_);
    const bool isCommentedHeader = mark != std::string::npos && readComment(mark);
    if (isCommentedHeader) line_.erase(0, 1);
    if (const int comma = commaAfterNothing(line_); comma > 0)
      fail(number_, "the field before comma " + std::to_string(comma) + " is empty" +
                        (comma == 1 && !hasRows_ && headerLine_ == 0
                             ? " (pandas writes its index so; use index=False)"
                             : ""));
    words_ = wordsOfLine(line_);
    if (words_.empty()) continue;
    if (hasRows_) return true;
    if (line_.find(';') < mark && line_.find('"') == line_.npos)
      fail(number_,
           "\";\" separates the numbers; separate them by commas or blanks, and write decimal "
           "points, "
           "not commas");
    // A header above the first row; one that is a comment may have been repeated as a line.
    if (isCommentedHeader || ((headerLine_ == 0 || headerIsComment_) && isHeaderLine(words_))) {
      if (headerLine_ == 0) {
        headerLine_ = number_;
        headerIsComment_ = isCommentedHeader;
        columns_ = words_;
        return isHeader_ = true;
      }
      if (words_ != columns_)
        fail(number_, "names other columns than line " + std::to_string(headerLine_) +
                          ", or in another order; delete one of the two lines");
      headerIsComment_ = isCommentedHeader;
      continue;
    }
    if (headerLine_ == 0) {
      Words sorted = words_, names = columns_;
      std::sort(sorted.begin(), sorted.end());
      std::sort(names.begin(), names.end());
      if (isName_ && sorted == names)
        fail(number_,
             "the names of all columns are numbers, so this may be a header or a row; for a row, "
             "write decimal points: 1.0, and for a header, quotes: \"1\"");
      if (likeHeader_ != 0) {
        std::string header;
        for (const std::string& name : columns_) header += (header.empty() ? "" : ",") + name;
        fail(likeHeader_,
             "the comment seems to be a header, but is not one; write the names only, as in \"" +
                 header + "\" (rad, m), or delete the comment");
      }
    }
    hasRows_ = true;
    return true;
  }
  return false;
}

bool TableLines::isHeaderLine(const Words& words) const {
  if (!isName_) return false;
  if (std::all_of(words.begin(), words.end(), isNumber))  // joints may be called 1 and 2
    return line_.find('"') != line_.npos && std::all_of(words.begin(), words.end(), isName_);
  return std::none_of(words.begin(), words.end(), isNumber) ||
         std::any_of(words.begin(), words.end(), isName_);
}

bool TableLines::readComment(std::size_t mark) {
  const std::string comment = line_.substr(mark + 1);
  const Words words = wordsOfLine(comment);
  if (repeats(columns_, words) && (hasRows_ || headerLine_ != 0 || mark > 0 || !isName_))
    return false;
  if (mark == 0 && isName_ && words.size() >= columns_.size() &&
      std::all_of(words.begin(), words.end(), isName_)) {
    if (hasRows_)
      fail(number_,
           "names other columns than the rows above it have, or in another order; delete "
           "the line, or make two files");
    return true;
  }
  if (hasRows_ && line_.find_first_not_of(" \t") < mark) return false;
  if (const std::string unit = otherUnit(comment); !unit.empty())
    fail(number_,
         "the comment says " + quotedWord(unit) +
             ", but the numbers are read in rad, m and s; convert them, or delete the comment if "
             "it is wrong");
  const bool isLikeHeader = resemblesHeader(comment, columns_);
  if (hasRows_) {
    if (isLikeHeader)
      fail(number_, "the comment seems to be a header, but the rows above it have the columns " +
                        joinedFirst(columns_) + "; delete the comment, or make two files");
    return false;
  }
  if (headerLine_ == 0 && likeHeader_ == 0 && isLikeHeader) likeHeader_ = number_;
  if (isLikeHeader || hasLetters(comment))
    notRead_.push_back(quotedWord(comment) + " (line " + std::to_string(number_) + ")");
  return false;
}

std::optional<Note> TableLines::note() const {
  if (notRead_.empty()) return std::nullopt;
  return Note{file_ + ": comments are not read: " + joinedFirst(notRead_, 3) +
                  "; the columns are " + joinedFirst(columns_) + ", in this order, in m and rad",
              NoteWeight::coverage};
}

void TableLines::fail(int line, const std::string& text) const {
  throw InputError(Fault{file_, line, text});
}

}  // namespace corridor
