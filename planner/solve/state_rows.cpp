#include "planner/solve/state_rows.h"

#include <algorithm>
#include <sstream>

#include "collision/core/read_file.h"
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

std::vector<StateRow> readStateRows(const std::filesystem::path& file,
                                    const ConfigurationSpace& space) {
  std::vector<StateRow> rows;
  FaultList faults(file.string());
  std::istringstream lines(readTextStream(file, "a file of states, one per line,"));
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    line.resize(std::min(line.size(), line.find('#')));
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    std::vector<double> values;
    std::string word, complaint;
    while (words >> word) {
      double value = 0;
      const std::string wrong = parseNumber(word, Range::Any, value);
      if (complaint.empty()) complaint = wrong;
      values.push_back(value);
    }
    if (values.empty()) continue;
    if (complaint.empty()) complaint = rowFault(values, space).value_or("");
    if (complaint.empty())
      rows.push_back(
          {number, Eigen::Map<const Configuration>(values.data(), Eigen::Index(values.size()))});
    else
      faults.add(file.string(), number, complaint);
  }
  if (rows.empty() && faults.size() == 0) faults.add(file.string(), 0, "no states");
  faults.throwIfAny();
  return rows;
}

}  // namespace corridor
