#include <algorithm>
#include <utility>

#include "collision/core/shortest.h"
#include "collision/core/spelling.h"
#include "collision/geometry/column_names.h"
#include "collision/geometry/point_readers.h"

namespace corridor {
namespace {

constexpr std::string_view kBlanks = " \t\r\v\f";

/// Removes the first word from the line and returns it. Blanks and the characters of `marks`
/// separate words.
std::string_view nextWord(std::string_view& line, std::string_view marks) {
  const auto separates = [&](char c) {
    return kBlanks.find(c) != kBlanks.npos || marks.find(c) != marks.npos;
  };
  const auto begin = std::find_if_not(line.begin(), line.end(), separates);
  const auto end = std::find_if(begin, line.end(), separates);
  const std::string_view word(begin, end);
  line = std::string_view(end, line.end());
  return word;
}

/// Returns the characters that, besides blanks, separate the numbers of a line. In a line with
/// semicolons, commas do not separate numbers, because they are decimal marks there. The reader
/// refuses numbers with decimal commas.
std::string_view marksOf(std::string_view line) {
  return line.find(';') != line.npos ? ";" : ",";
}

/// Returns whether the commas of a line may be decimal marks, as in "1,5 2,5 3,5". This is assumed
/// if at least one comma has no blank on either side, and at least two numbers are separated by
/// blanks alone.
bool mixesCommasAndBlanks(std::string_view line) {
  const auto isBlank = [](char c) { return kBlanks.find(c) != kBlanks.npos; };
  bool alone = false, tight = false;
  for (std::size_t i = 1; i + 1 < line.size(); ++i) {
    if (line[i] == ',') tight = tight || (!isBlank(line[i - 1]) && !isBlank(line[i + 1]));
    if (!isBlank(line[i])) continue;
    const std::size_t before = line.find_last_not_of(kBlanks, i),
                      after = line.find_first_not_of(kBlanks, i);
    alone = alone || (before != line.npos && after != line.npos && line[before] != ',' &&
                      line[after] != ',');
  }
  return alone && tight;
}

/// Returns whether these words name the columns: x, y, z in upper or lower case.
bool areNames(std::string_view x, std::string_view y, std::string_view z) {
  return lowered(std::string(x)) == "x" && lowered(std::string(y)) == "y" &&
         lowered(std::string(z)) == "z";
}

bool isNumber(std::string_view word) {
  double value = 0;
  return !parseCoordinate(word, value, true);
}

/// Adds a fault for a comment, or a header, that does not fit the columns as they are read.
void checkNames(const ColumnNames& names, double metresPerUnit, int line, MeshFaults& faults) {
  if (names.order == ColumnNames::Order::other)
    faults.add(line,
               "names x, y and z in another order or place than the first three columns, which "
               "are read as x, y, z; put these columns first, or remove the line if it is wrong");
  else if (names.metresPerUnit.value_or(metresPerUnit) != metresPerUnit)
    faults.add(line, "says that a unit is " + shortest(*names.metresPerUnit) +
                         " m, but coordinates are read with a unit of " + shortest(metresPerUnit) +
                         " m; state the unit, or remove the line if it is wrong");
}

}  // namespace

PointCloud readXyz(std::string_view text, double metresPerUnit, MeshFaults& faults) {
  PointCloud cloud{{}, "text"};
  std::int64_t promised = -1;  // the number of points, with which .pts files begin; -1: not stated
  int number = 0;
  while (!text.empty()) {
    ++number;
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::string_view whole = line, marks = marksOf(line);
    const std::string_view first = nextWord(line, marks);
    if (first.empty()) continue;
    if (first.front() == '#' || first.starts_with("//")) {
      if (!cloud.points.empty()) continue;
      const ColumnNames names = columnNamesIn(whole);
      checkNames(names, metresPerUnit, number, faults);
      if (names.hasWords && names.order == ColumnNames::Order::none && cloud.comment == 0)
        cloud.comment = number;
      continue;
    }
    const std::string_view second = nextWord(line, marks), third = nextWord(line, marks);
    if (cloud.points.empty() && promised < 0) {
      if (second.empty() && parseInteger(first, promised)) continue;
      if (areNames(first, second, third)) {
        checkNames(columnNamesIn(whole), metresPerUnit, number, faults);
        continue;
      }
    }
    if (cloud.points.empty() && !third.empty() && !isNumber(first) && !isNumber(second) &&
        !isNumber(third)) {
      faults.add(number, "is a header that begins with " + inQuotes(first) +
                             ", not with x y z; put x, y and z into the first three columns, in "
                             "metres, and remove the header");
      continue;
    }
    if (third.empty()) {
      faults.add(number,
                 "a point has 3 coordinates, found " + std::to_string(second.empty() ? 1 : 2));
      continue;
    }
    if (marks == "," && mixesCommasAndBlanks(whole)) {
      faults.add(number,
                 "has commas and blanks between numbers; use one of them, and write "
                 "decimals with a point");
      continue;
    }
    Vec3& point = cloud.points.emplace_back();
    for (const auto& [word, axis] :
         {std::pair(first, 0), std::pair(second, 1), std::pair(third, 2)})
      if (const auto why = parseCoordinate(word, point[axis], true)) {
        faults.add(number, *why);
        break;
      }
    limitPoints(cloud.points.size(), number, faults);
  }
  if (promised >= 0 && static_cast<std::uint64_t>(promised) != cloud.points.size())
    faults.add(0, "its first line promises " + std::to_string(promised) + " points, but it has " +
                      std::to_string(cloud.points.size()));
  return cloud;
}

}  // namespace corridor
