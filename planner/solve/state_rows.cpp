#include "planner/solve/state_rows.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "collision/core/fault_list.h"
#include "collision/core/read_file.h"
#include "collision/core/spelling.h"
#include "planner/problem/number_text.h"
#include "planner/problem/table_lines.h"

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
  std::function<bool(const std::string&)> isName;
  if (allowHeader)
    isName = [&](const std::string& word) {
      return std::find(names.begin(), names.end(), word) != names.end();
    };
  else
    inOrder.insert(inOrder.end(), names.begin(), names.end());
  TableLines lines(file.string(), readTextStream(file, "a file of " + what + "s, one per line,"),
                   inOrder, isName);
  while (lines.next()) {
    if (lines.isHeader()) {
      columns = readHeader(lines.words(), names, file.string(), lines.number(), faults);
      faults.throwIfAny();
      continue;
    }
    std::vector<double> values;
    std::string complaint;
    for (const std::string& word : lines.words()) {
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
      rows.push_back({lines.number(), values});
    else
      faults.add(file.string(), lines.number(), complaint);
  }
  if (rows.empty() && faults.size() == 0) faults.add(file.string(), 0, "no " + what + "s");
  faults.throwIfAny();
  if (auto note = lines.note()) notes.push_back(std::move(*note));
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
