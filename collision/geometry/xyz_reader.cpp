#include <algorithm>
#include <array>
#include <utility>

#include "collision/core/shortest.h"
#include "collision/core/spelling.h"
#include "collision/geometry/column_names.h"
#include "collision/geometry/point_readers.h"

namespace corridor {
namespace {

constexpr std::string_view kBlanks = " \t\v\f";

/// Removes the first word from the line and returns it. Blanks and `mark` separate words.
std::string_view nextWord(std::string_view& line, char mark) {
  const auto separates = [&](char c) { return c == mark || isBlank(c); };
  const auto begin = std::find_if_not(line.begin(), line.end(), separates);
  const auto end = std::find_if(begin, line.end(), separates);
  const std::string_view word(begin, end);
  line = std::string_view(end, line.end());
  return word;
}

/// The first three words of a line. Words that the line does not have are empty.
struct Row {
  std::array<std::string_view, 3> words;
  std::string_view rest;  ///< after these words
  /// The number of the first comma (or semicolon) before the third word that has only blanks before
  /// it, back to another comma or the line's start; 0: none.
  int emptyField = 0;
};

Row rowOf(std::string_view line, char mark) {
  Row row;
  int all = 0;  // commas
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string_view before = line;
    row.words[i] = nextWord(line, mark);
    const std::string_view between =
        before.substr(0, before.size() - line.size() - row.words[i].size());
    const auto count = static_cast<int>(std::count(between.begin(), between.end(), mark));
    if (row.emptyField == 0 && count > (i == 0 ? 0 : 1)) row.emptyField = all + (i == 0 ? 1 : 2);
    all += count;
    if (row.words[i].empty()) break;
  }
  row.rest = line;
  return row;
}

/// Returns the character that, besides blanks, separates the numbers of a line. In a line with
/// semicolons, commas do not separate numbers, because they are decimal marks there. The reader
/// refuses numbers with decimal commas.
char markOf(std::string_view line) {
  return line.find(';') != line.npos ? ';' : ',';
}

/// Returns whether the commas of a line may be decimal marks, as in "1,5 2,5 3,5". This is assumed
/// if at least one comma has no blank on either side, and at least two numbers are separated by
/// blanks alone.
bool mixesCommasAndBlanks(std::string_view line) {
  if (line.find(',') == line.npos) return false;
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

/// Returns whether every second comma is a decimal mark, as in "1,5, 2,5, 3,5": it has no blank on
/// either side, and each other comma has one.
bool separatesByEverySecondComma(std::string_view line) {
  int commas = 0;
  for (std::size_t i = 1; i + 1 < line.size(); ++i) {
    if (line[i] != ',') continue;
    const bool tight = !isBlank(line[i - 1]) && !isBlank(line[i + 1]);
    if (tight != (commas++ % 2 == 0)) return false;
  }
  return commas >= 5 && commas % 2 == 1;
}

/// Returns whether semicolons separate groups of numbers, as in "1 2 3; 4 5 6".
bool hasGroups(std::string_view line) {
  for (std::size_t begin = 0; begin < line.size() && line.find(';') != line.npos;) {
    const std::size_t end = std::min(line.find(';', begin), line.size());
    std::string_view group = line.substr(begin, end - begin);
    double number = 0;
    int numbers = 0;
    for (std::string_view word = nextWord(group, ';');
         !word.empty() && !parseCoordinate(word, number, true); word = nextWord(group, ';'))
      ++numbers;
    if (numbers > 1) return true;
    begin = end + 1;
  }
  return false;
}

/// Returns the metres of a unit's name in any brackets, such as "mm" or "[mm]", or 0. Here "in" is
/// a unit.
double metresOfWord(std::string_view word) {
  constexpr std::string_view brackets = "[](){}\"'.";
  while (!word.empty() && brackets.find(word.front()) != brackets.npos) word.remove_prefix(1);
  while (!word.empty() && brackets.find(word.back()) != brackets.npos) word.remove_suffix(1);
  const std::string name = lowered(std::string(word));
  return name == "in" ? 0.0254 : metresOfUnit(name);
}

/// Returns whether the first three columns of a header are x, y, z in upper or lower case. They may
/// be in quotes and have units: "x","y","z" or x[mm],y [mm],z_mm.
bool beginsWithNames(std::string_view header, char mark) {
  std::string plain = lowered(header);
  std::erase(plain, '"');
  for (std::size_t at = 0; (at = plain.find_first_of("[(_", at)) != plain.npos;) {
    const std::size_t end =
        plain[at] == '_' ? plain.find_first_of(" \t,;", at) : plain.find_first_of(")]", at);
    const std::size_t size = std::min(end, plain.size()) - at;
    if (metresOfWord(plain.substr(at + 1, size - 1)) > 0)
      plain.replace(at, plain[at] == '_' ? size : size + 1, " ");
    else
      ++at;
  }
  const Row row = rowOf(plain, mark);
  return row.emptyField == 0 && row.words == std::array<std::string_view, 3>{"x", "y", "z"};
}

bool isNumber(std::string_view word) {
  double value = 0;
  return !parseCoordinate(word, value, true);
}

/// Reads a text file of points.
class XyzReader {
 public:
  XyzReader(std::string_view text, double metresPerUnit, MeshFaults& faults)
      : cursor_(text), metresPerUnit_(metresPerUnit), faults_(faults) {}

  PointCloud read() {
    do readLine(cursor_.takeRestOfLine());
    while (cursor_.nextLine());
    if (promised_ >= 0 && static_cast<std::uint64_t>(promised_) != cloud_.points.size())
      faults_.add(0, "its first line promises " + std::to_string(promised_) +
                         " points, but it has " + std::to_string(cloud_.points.size()));
    return std::move(cloud_);
  }

 private:
  void fault(std::string text) { faults_.add(cursor_.line(), std::move(text)); }

  void readLine(std::string_view line) {
    const char mark = markOf(line);
    const Row row = rowOf(line, mark);
    const auto& [first, second, third] = row.words;
    if (first.empty()) return;
    if (first.front() == '#' || first.starts_with("//")) return readComment(line);
    if (row.emptyField > 0) return faultEmptyField(row, mark);
    if (cloud_.points.empty() && promised_ < 0 && second.empty() && parseInteger(first, promised_))
      return;
    if (cloud_.points.empty() && !third.empty() &&
        std::none_of(row.words.begin(), row.words.end(), isNumber))
      return readHeader(line, mark, first);
    if (third.empty())
      return fault("a point has 3 coordinates, found " + std::to_string(second.empty() ? 1 : 2));
    if (mark == ';' && hasGroups(line))
      return fault("semicolons separate groups of numbers; write a line for each point");
    if (mark == ',' && (mixesCommasAndBlanks(line) || separatesByEverySecondComma(line)))
      return fault(
          "has commas and blanks between numbers; use one of them, and write decimals with a "
          "point");
    Vec3& point = cloud_.points.emplace_back();
    for (int axis = 0; axis < 3; ++axis)
      if (const auto why =
              parseCoordinate(row.words[static_cast<std::size_t>(axis)], point[axis], true)) {
        fault(*why);
        break;
      }
    const int more = readRest(row.rest, mark);
    checkColumns(line, 3 + more);
    if (!hasHeader_) cloud_.unnamedColumns = std::max(cloud_.unnamedColumns, more);
    limitPoints(cloud_.points.size(), cursor_.line(), faults_);
  }

  /// Reads a line that is a comment, which may name the columns. Files that were put together may
  /// have such lines among the points.
  void readComment(std::string_view line) {
    ColumnNames names = columnNamesIn(line);
    // In "#,x,y,z" the mark of comments is the name of the first column, an index.
    const std::string_view text =
        line.substr(std::min(line.find_first_not_of(" \t#/"), line.size()));
    if (rowOf(text, markOf(text)).emptyField > 0 && names.order == ColumnNames::Order::xyz)
      names.order = ColumnNames::Order::other;
    checkNames(names);
    if (names.hasWords && names.order == ColumnNames::Order::none && cloud_.comment == 0 &&
        cloud_.points.empty())
      cloud_.comment = cursor_.line();
  }

  void readHeader(std::string_view line, char mark, std::string_view first) {
    hasHeader_ = true;
    if (beginsWithNames(line, mark)) return checkNames(columnNamesIn(line));
    fault("is a header that begins with " + inQuotes(first) +
          ", not with x y z; put the columns x, y and z first, and name them in this way");
  }

  /// Adds a fault for a comment, or a header, that does not fit the columns as they are read.
  void checkNames(const ColumnNames& names) {
    if (names.order == ColumnNames::Order::other)
      fault(
          "names x, y and z in another order or place than the first three columns, which are read "
          "as x, y, z; put these columns first, or remove the line if it is wrong");
    else if (names.metresPerUnit && !isSameUnit(*names.metresPerUnit, metresPerUnit_))
      fault("says that a unit is " + shortest(*names.metresPerUnit) +
            " m, but coordinates are read with a unit of " + shortest(metresPerUnit_) +
            " m; state the unit" + howToState(*names.metresPerUnit) +
            ", or remove the line if it is wrong");
  }
  /// Adds a fault for a comment beside a point that states another unit.
  void checkUnit(ColumnNames names) {
    names.order = ColumnNames::Order::none;
    if (names.isOnUnits) checkNames(names);
  }

  void faultEmptyField(const Row& row, char mark) {
    const bool isIndex = row.emptyField == 1 && cloud_.points.empty();
    fault("the field before " + std::string(mark == ';' ? "semicolon " : "comma ") +
          std::to_string(row.emptyField) + " is empty" +
          (isIndex ? " (pandas writes its index so; use index=False)" : ""));
  }

  /// Checks what follows the coordinates of a point: colours, labels or a comment; no other unit.
  /// @returns the number of words.
  int readRest(std::string_view rest, char mark) {
    for (int i = 0;; ++i) {
      const std::string_view before = rest, word = nextWord(rest, mark);
      if (word.empty()) return i;
      if (word.starts_with('#') || word.starts_with("//")) {
        const std::string_view comment = before.substr(std::size_t(word.data() - before.data()));
        if (const double metres = metresOfWord(withoutMarks(comment)); metres > 0)
          checkUnitWord(comment, metres);
        else
          checkUnit(columnNamesIn(comment));
        return i;
      }
      const char c = word.front();
      if ((c >= '0' && c <= '9') || c == '-') continue;
      // "in" is a unit only where a unit of all three coordinates would be.
      if (const double metres = metresOfWord(word);
          metres > 0 && (i == 0 || lowered(std::string(word)) != "in"))
        checkUnitWord(word, metres);
    }
  }
  /// Adds a fault if two tabs in a row may be an empty field: the first point has more columns, or
  /// fewer.
  void checkColumns(std::string_view line, int columns) {
    const bool hasTwoTabs = line.find("\t\t") != line.npos;
    if (cloud_.points.size() == 1) {
      columns_ = columns;
      firstLine_ = cursor_.line();
      firstHasTwoTabs_ = hasTwoTabs;
    } else if (columns != columns_ && (hasTwoTabs || firstHasTwoTabs_)) {
      fault("has " + std::to_string(columns) + " columns, but line " + std::to_string(firstLine_) +
            " has " + std::to_string(columns_) +
            ", and two tabs in a row may be an empty field; fill it, or write one tab between "
            "numbers");
    }
  }
  static std::string_view withoutMarks(std::string_view comment) {
    while (!comment.empty() && std::string_view("#/ \t").find(comment.front()) != comment.npos)
      comment.remove_prefix(1);
    return comment;
  }
  void checkUnitWord(std::string_view word, double metres) {
    if (!isSameUnit(metres, metresPerUnit_))
      fault(inQuotes(word) + " follows the coordinates, which are read with a unit of " +
            shortest(metresPerUnit_) + " m; state the unit" + howToState(metres) +
            ", or remove the word if it is no unit");
  }

  TextCursor cursor_;
  double metresPerUnit_;
  MeshFaults& faults_;
  PointCloud cloud_{{}, "text"};
  int columns_ = 0, firstLine_ = 0;  // of the first point
  bool firstHasTwoTabs_ = false, hasHeader_ = false;
  std::int64_t promised_ = -1;  // number of points, with which .pts files begin; -1: not stated
};

}  // namespace

PointCloud readXyz(std::string_view text, double metresPerUnit, MeshFaults& faults) {
  return XyzReader(text, metresPerUnit, faults).read();
}

}  // namespace corridor
