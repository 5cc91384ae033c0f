#include "planner/solve/state_rows.h"

#include <algorithm>
#include <sstream>
#include <utility>

#include "collision/core/read_file.h"
#include "collision/core/spelling.h"
#include "planner/problem/table_text.h"
#include "planner/problem/text_words.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {

std::string rigidSpaceOf(const ConfigurationSpace& space) {
  if (space.groups().size() != 1) return "";
  switch (space.groups().front().kind) {
    case CoordinateGroup::Kind::planar:
      return "SE2";
    case CoordinateGroup::Kind::floating:
      return "SE3";
    case CoordinateGroup::Kind::joints:
      break;
  }
  return "";
}

std::optional<std::string> rowFault(const std::vector<double>& row,
                                    const ConfigurationSpace& space) {
  if (row.size() != space.size()) {
    const std::vector<std::string> names = space.numberNames();
    const std::string rigid = rigidSpaceOf(space);
    std::string listed;
    for (const std::string& name : names) listed += (listed.empty() ? "" : " ") + name;
    return "a state" + (rigid.empty() ? "" : " of " + rigid) + " has " +
           std::to_string(space.size()) + " numbers (" + listed + "), not " +
           std::to_string(row.size());
  }
  const Configuration q = Eigen::Map<const Configuration>(row.data(), Eigen::Index(row.size()));
  if (!space.isFinite(q)) return "a quaternion of zeros is no rotation";
  return std::nullopt;
}

namespace {

/// Returns, for each column of a header, the index of the number that it names. Adds a fault for a
/// name that is unknown or repeated, and for names that are missing.
std::vector<std::size_t> readHeader(const std::vector<std::string>& header,
                                    const std::vector<std::string>& names, const std::string& file,
                                    int line, FaultList& faults) {
  std::vector<std::size_t> columns;
  std::vector<std::string> missing = names;
  for (const std::string& word : header) {
    const auto name = std::find(names.begin(), names.end(), word);
    const auto left = std::find(missing.begin(), missing.end(), word);
    if (name == names.end())
      faults.add(file, line,
                 "the header has the column " + quotedWord(word) +
                     ", which this problem's states do not have" + didYouMean(word, names) +
                     knownWords(names));
    else if (left == missing.end())
      faults.add(file, line, "the header names " + quotedWord(word) + " twice");
    else
      missing.erase(left);
    columns.push_back(static_cast<std::size_t>(name - names.begin()));
  }
  if (!missing.empty()) faults.add(file, line, "the header lacks " + joinedFirst(missing));
  return columns;
}

/// The numbers of a line of the file; `line` is counted from 1.
struct Row {
  int line = 0;
  std::vector<double> values;
};

/// Reads all lines of numbers. Only `wrongWith` decides whether a line has the right count of
/// numbers.
/// @param what the content of a line, for messages: "state" or "edge".
/// @param allowHeader whether the first line may be a header.
template <class WrongWith>
std::vector<Row> readRows(const std::filesystem::path& file, const ConfigurationSpace& space,
                          const std::string& what, bool allowHeader, const WrongWith& wrongWith,
                          std::vector<Note>& notes) {
  std::vector<Row> rows;
  FaultList faults(file.string());
  const std::vector<std::string> names = space.numberNames();
  std::vector<std::size_t> columns;          // the number that each column holds; empty: no header
  std::vector<std::string> inOrder = names;  // the names of the numbers of a row without header
  if (!allowHeader) inOrder.insert(inOrder.end(), names.begin(), names.end());
  bool isFirst = true;
  int likeHeader = 0;  // the line of a comment that may be meant as the header; 0: none
  int notRead = 0;     // the line of the first other comment before the first row; 0: none
  std::istringstream lines(readTextStream(file, "a file of " + what + "s, one per line,"));
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (number == 1 && line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);  // byte-order mark
    // numpy.savetxt writes its header as a comment.
    if (const std::size_t mark = line.find('#');
        rows.empty() && faults.size() == 0 && mark != std::string::npos) {
      const std::string comment = line.substr(mark + 1);
      std::vector<std::string> words = wordsOfLine(comment), sorted = names;
      // In a file of edges, both states are in the order of the names.
      const bool namesAState = words == names || words == inOrder;
      std::sort(words.begin(), words.end());
      std::sort(sorted.begin(), sorted.end());
      if (mark == 0 && allowHeader && words == sorted) {
        if (!isFirst)
          throw InputError(
              Fault{file.string(), number, "the file has two headers; keep one of them"});
        line.erase(0, 1);
      } else if (isFirst && !namesAState && likeHeader == 0 && resemblesHeader(comment, inOrder)) {
        likeHeader = number;
      } else if (!namesAState && notRead == 0 && wordsOfLine(line).empty() && hasLetters(comment)) {
        notRead = number;
      }
    }
    const std::vector<std::string> words = wordsOfLine(line);
    if (words.empty()) continue;
    if (const std::string wrong = wrongFields(line, isFirst, names); !wrong.empty())
      throw InputError(Fault{file.string(), number, wrong});
    // A name may look like a number (a joint "1"). So the first line is a header only if one of its
    // words is not a number, and one of its words is a name.
    double number0 = 0;
    const bool isHeader =
        allowHeader &&
        std::any_of(words.begin(), words.end(),
                    [&](const std::string& word) {
                      return !parseNumber(word, Range::Any, number0).empty();
                    }) &&
        std::find_first_of(words.begin(), words.end(), names.begin(), names.end()) != words.end();
    if (std::exchange(isFirst, false) && isHeader) {
      columns = readHeader(words, names, file.string(), number, faults);
      faults.throwIfAny();
      inOrder = words;
      continue;
    }
    if (likeHeader != 0 && columns.empty())
      throw InputError(Fault{file.string(), likeHeader, resemblesHeaderText(inOrder)});
    std::vector<double> values;
    std::string complaint;
    for (const std::string& word : words) {
      double value = 0;
      const std::string wrong = parseNumber(word, Range::Any, value);
      if (complaint.empty()) complaint = wrong;
      values.push_back(value);
    }
    if (values.size() == columns.size()) {
      const std::vector<double> given = values;
      for (std::size_t i = 0; i < columns.size(); ++i) values[columns[i]] = given[i];
    }
    if (complaint.empty()) complaint = wrongWith(values).value_or("");
    if (complaint.empty())
      rows.push_back({number, values});
    else
      faults.add(file.string(), number, complaint);
  }
  if (rows.empty() && faults.size() == 0) faults.add(file.string(), 0, "no " + what + "s");
  faults.throwIfAny();
  if (notRead != 0)
    notes.push_back({file.string() + ": " + notReadText(notRead, inOrder), NoteWeight::coverage});
  return rows;
}

Configuration stateOf(const std::vector<double>& values, std::size_t first, std::size_t size) {
  return Eigen::Map<const Configuration>(values.data() + first, static_cast<Eigen::Index>(size));
}

}  // namespace

std::vector<StateRow> readStateRows(const std::filesystem::path& file,
                                    const ConfigurationSpace& space, std::vector<Note>& notes) {
  std::vector<StateRow> states;
  const auto wrongWith = [&](const std::vector<double>& row) { return rowFault(row, space); };
  for (const Row& row : readRows(file, space, "state", true, wrongWith, notes))
    states.push_back({row.line, stateOf(row.values, 0, space.size())});
  return states;
}

std::vector<EdgeRow> readEdgeRows(const std::filesystem::path& file,
                                  const ConfigurationSpace& space, std::vector<Note>& notes) {
  const std::size_t size = space.size();
  const auto wrongWith = [&](const std::vector<double>& row) -> std::optional<std::string> {
    if (row.size() != 2 * size)
      return "an edge has " + std::to_string(2 * size) + " numbers, those of its two states, not " +
             std::to_string(row.size());
    const auto middle = row.begin() + static_cast<std::ptrdiff_t>(size);
    if (auto wrong = rowFault({row.begin(), middle}, space)) return wrong;
    return rowFault({middle, row.end()}, space);
  };
  std::vector<EdgeRow> edges;
  for (const Row& row : readRows(file, space, "edge", false, wrongWith, notes))
    edges.push_back({row.line, stateOf(row.values, 0, size), stateOf(row.values, size, size)});
  return edges;
}

}  // namespace corridor
