#include "planner/trajectory/trajectory_text.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

#include "collision/core/csv_text.h"
#include "collision/core/shortest.h"
#include "collision/core/spelling.h"
#include "planner/problem/text_words.h"
#include "planner/problem/yaml_reader.h"
#include "planner/trajectory/trajectory_table.h"

namespace corridor {
namespace {

constexpr double kPerSecond = 1e9;

std::string joined(const Configuration& values, const char* separator) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : separator) + shortest(value);
  return text;
}

/// Returns the indices of the numbers that have velocities: all except those of rotations.
std::vector<Eigen::Index> withVelocities(const ConfigurationSpace& space) {
  std::vector<Eigen::Index> all;
  for (const Coordinate& c : space.coordinates())
    if (c.kind != Coordinate::Kind::rotation) all.push_back(static_cast<Eigen::Index>(c.first));
  return all;
}

/// Makes the names of columns such that `readCsvTable` reads them as what they are: a joint may be
/// called "time", or "a_velocity" beside a joint "a".
class ColumnNames {
 public:
  explicit ColumnNames(const Model& model) : names_(model) {}

  std::string time() const {
    return meaning({ColumnQuantity::time, ""}, {"time", "time_from_start", "t"});
  }
  static std::string position(const std::string& joint) { return asWord(joint); }
  /// @param word "velocity" or "acceleration"
  std::string of(ColumnQuantity quantity, const std::string& word, const std::string& joint) const {
    return meaning({quantity, joint}, {joint + "_" + word, word + "/" + joint, joint + "." + word,
                                       joint + "/" + word, word + "_" + joint, word + "." + joint});
  }

 private:
  /// Returns the first of the names that the reader takes for the column.
  std::string meaning(const TableColumn& column, const std::vector<std::string>& all) const {
    for (const std::string& name : all) {
      const TableColumn read = columnOf(name, names_);
      const bool isTime = column.quantity == ColumnQuantity::time;
      if (read.quantity == column.quantity && (isTime || read.joint == column.joint))
        return asWord(name);
    }
    throw std::invalid_argument("the names of the joints leave none for the column " +
                                quotedWord(all.front()) +
                                "; rename a joint, or write the trajectory as YAML");
  }
  static std::string asWord(const std::string& name) {
    double number = 0;
    const bool isPlain = name.find_first_of(",;\"# \t\r\n") == name.npos &&
                         !parseNumber(name, Range::Any, number).empty();
    return isPlain ? name : inDoubleQuotes(name);
  }

  JointNames names_;
};

}  // namespace

bool hasRotation(const ConfigurationSpace& space) {
  for (const Coordinate& c : space.coordinates())
    if (c.kind == Coordinate::Kind::rotation) return true;
  return false;
}

double nearestNanosecond(double seconds) {
  return std::round(seconds * kPerSecond) / kPerSecond;
}

std::string csvText(const TrajectoryRows& rows, const Model& model) {
  const ConfigurationSpace& space = model.space;
  const std::vector<std::string> names = space.numberNames();
  const std::vector<Eigen::Index> moving = withVelocities(space);
  const ColumnNames columns(model);
  std::vector<std::string> header;
  if (rows.timed) header.push_back(columns.time());
  for (const std::string& name : names) header.push_back(ColumnNames::position(name));
  const auto add = [&](ColumnQuantity quantity, const char* word) {
    for (const Eigen::Index i : moving)
      header.push_back(columns.of(quantity, word, names[static_cast<std::size_t>(i)]));
  };
  if (rows.hasVelocities) add(ColumnQuantity::velocity, "velocity");
  if (rows.hasAccelerations) add(ColumnQuantity::acceleration, "acceleration");
  std::string text;
  for (const std::string& name : header) text += (text.empty() ? "" : ",") + name;
  text += "\n";
  for (const TrajectoryRow& row : rows.rows) {
    text += (rows.timed ? shortest(row.time) + "," : "") + joined(row.positions, ",");
    if (rows.hasVelocities)
      for (const Eigen::Index i : moving) text += "," + shortest(row.velocities[i]);
    if (rows.hasAccelerations)
      for (const Eigen::Index i : moving) text += "," + shortest(row.accelerations[i]);
    text += "\n";
  }
  return text;
}

std::string messageText(const TrajectoryRows& rows, const ConfigurationSpace& space) {
  if (hasRotation(space))
    throw std::invalid_argument("a JointTrajectory has no rotations of floating joints");
  if (!rows.timed) throw std::invalid_argument("a JointTrajectory needs times");
  std::string text = "joint_names: [";
  const std::vector<std::string> names = space.numberNames();
  for (std::size_t i = 0; i < names.size(); ++i) text += (i ? ", " : "") + yamlText(names[i]);
  text += "]\npoints:\n";
  for (const TrajectoryRow& row : rows.rows) {
    if (!(row.time >= 0 && row.time < 0x1p53 / kPerSecond) ||
        nearestNanosecond(row.time) != row.time)
      throw std::invalid_argument("the time " + shortest(row.time) +
                                  " s is not a whole number of nanoseconds");
    const auto total = static_cast<std::uint64_t>(std::round(row.time * kPerSecond));
    text += "- positions: [" + joined(row.positions, ", ") + "]\n";
    if (rows.hasVelocities) text += "  velocities: [" + joined(row.velocities, ", ") + "]\n";
    if (rows.hasAccelerations)
      text += "  accelerations: [" + joined(row.accelerations, ", ") + "]\n";
    text += "  time_from_start: {sec: " + std::to_string(total / 1'000'000'000) +
            ", nanosec: " + std::to_string(total % 1'000'000'000) + "}\n";
  }
  return text;
}

}  // namespace corridor
