#pragma once

#include <functional>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "planner/robot/note.h"

namespace corridor {

/// Returns whether a comment seems to be meant as the header of a table: `turn [deg], slide [m]`.
/// Such a comment must not be skipped, because the columns may be in its order, or in its units.
/// It mentions at least half of the names, and half of its words are names, or it mentions three
/// names or more, and all. Case does not matter, and a name may have a prefix or suffix: turn_deg.
/// The part of a name behind the last "/" counts, too: "y x yaw" for drive/x, drive/y, drive/yaw.
/// @param names the names of the columns of a table without a header.
bool resemblesHeader(const std::string& comment, const std::vector<std::string>& names);

/// Returns the name of another unit than rad, m and s that a comment, or a column's name, clearly
/// gives to the numbers: `[deg]`, `(mm)`, `in degrees`, `angles: deg`, `units: rad and cm`, `deg,
/// m`. Otherwise returns "". (A title may say that a joint turns by 90 degrees.)
std::string otherUnit(const std::string& comment);

/// Goes through a table of numbers (CSV): trajectories, states, edges. Words are separated by
/// blanks or commas, and `#` begins a comment. The first line may be a header. The header may be a
/// comment, as numpy.savetxt writes it: a comment of names only, one for each column or more.
///
/// All functions throw InputError for a line that may be misread:
/// - an empty field between commas, which would move the fields behind it to other columns;
/// - ";" as a separator;
/// - a first line of numbers that are all the names: a header or a row;
/// - a comment that resembles a header, if the table has none; a second header with other words;
/// - a comment that clearly gives another unit: `[deg]`, `in degrees`.
/// Comments behind the numbers of the second and later rows are not read.
class TableLines {
 public:
  /// @param columns the names of the columns of a table without a header.
  /// @param isName returns whether a word of a header names a column; null: there is no header.
  TableLines(std::string file, const std::string& text, std::vector<std::string> columns,
             std::function<bool(const std::string&)> isName);

  /// Goes to the next line with words. Returns false at the end of the table.
  bool next();
  int number() const { return number_; }  ///< of the line, counted from 1
  const std::vector<std::string>& words() const { return words_; }
  bool isHeader() const { return isHeader_; }  ///< of the line; false for all lines but the first

  /// Returns a note on the comments before or on the first row that have letters and are not the
  /// header, because such comments are not read.
  std::optional<Note> note() const;

 private:
  bool isHeaderLine(const std::vector<std::string>& words) const;
  /// Reads the comment of `line_`. Returns whether it is the header.
  bool readComment(std::size_t mark);
  [[noreturn]] void fail(int line, const std::string& text) const;

  std::string file_;
  std::istringstream lines_;
  std::vector<std::string> columns_;  // as given, or those of the header
  std::function<bool(const std::string&)> isName_;
  std::string line_;
  std::vector<std::string> words_;
  int number_ = 0;
  bool isHeader_ = false;
  int headerLine_ = 0;  // 0: none
  bool headerIsComment_ = false;
  bool hasRows_ = false;
  int likeHeader_ = 0;                // the line of a comment that resembles a header; 0: none
  std::vector<std::string> notRead_;  // comments with letters, and their lines
};

}  // namespace corridor
