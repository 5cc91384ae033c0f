#pragma once

#include <string>
#include <vector>

/// What could be misread in tables of numbers (CSV): trajectories, states and edges.
namespace corridor {

/// Returns what is wrong with a line of a table of numbers, or "". An empty field between commas is
/// wrong, because `wordsOfLine` would move the fields behind it to other columns; a comma at the
/// end is not. @param isFirst whether this is the first line that is no comment: it may be a
/// header.
/// @param names the names of the columns. A first line of numbers that are all the names is wrong,
/// because it may be a header or a row.
std::string wrongFields(const std::string& line, bool isFirst,
                        const std::vector<std::string>& names);

/// Returns whether a comment seems to be meant as the header of a table: `turn [deg], slide [m]`.
/// Such a comment must not be skipped, because the columns may be in its order, or in its units.
/// It mentions at least half of the names, and half of its words are names, or it mentions three
/// names or more, and all. Case does not matter, and a name may have a prefix or suffix: turn_deg.
/// The part of a name behind the last "/" counts, too: "y x yaw" for drive/x, drive/y, drive/yaw.
/// Exactly the names, in their order, say nothing that the table does not say: returns false.
/// @param names the names of the columns of a table without a header.
bool resemblesHeader(const std::string& comment, const std::vector<std::string>& names);
/// Returns the message for such a comment. @param names the columns in the order of the rows.
std::string resemblesHeaderText(const std::vector<std::string>& names);

/// Returns whether a comment has a letter. If it is before the first row, it may say something
/// about the columns that this function's callers do not read, so `notReadText` is then in a note.
bool hasLetters(const std::string& comment);
/// Returns the text of that note. @param columns the names of the columns, in their order.
std::string notReadText(int line, const std::vector<std::string>& columns);

}  // namespace corridor
