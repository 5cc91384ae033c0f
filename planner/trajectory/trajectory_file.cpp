#include "planner/trajectory/trajectory_file.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "collision/core/error.h"
#include "collision/core/read_file.h"
#include "collision/core/shortest.h"
#include "collision/core/spelling.h"
#include "collision/core/text_encoding.h"
#include "planner/trajectory/row_faults.h"
#include "planner/trajectory/trajectory_table.h"
#include "planner/trajectory/unplanned_columns.h"

namespace corridor {
namespace {

using Meaning = JointNames::Meaning;

/// Removes lines from `text` up to the next line that is neither empty nor a comment, and returns
/// this line without blanks at its ends. Returns "" if there is no such line.
std::string_view nextLine(std::string_view& text) {
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first == std::string_view::npos || line[first] == '#') continue;
    return line.substr(first, line.find_last_not_of(" \t\r") + 1 - first);
  }
  return {};
}

/// Returns whether a line looks like YAML or JSON: it begins with a bracket or a list item, or it
/// has a key with a colon.
bool isYamlLine(std::string_view line) {
  if (line.starts_with('{') || line.starts_with('[') || line.starts_with("---") ||
      line.starts_with("%YAML") || line == "-" || line.starts_with("- "))
    return true;
  const std::size_t colon = line.find(':');
  return colon != std::string_view::npos && colon > 0 &&
         line.substr(0, colon).find_first_of(", \t") == std::string_view::npos &&
         (colon + 1 == line.size() || line[colon + 1] == ' ' || line[colon + 1] == '\t');
}

/// Converts the rows of a table to rows of configurations.
class RowMaker {
 public:
  RowMaker(const std::string& file, const Model& model, const JointNames& names)
      : file_(file), model_(model), names_(names), faults_(file) {}

  TrajectoryRows make(TrajectoryTable table) {
    const Columns positions = columnsOf(table.positions, table, "position");
    const Columns velocities = columnsOf(table.velocities, table, "velocity");
    const Columns accelerations = columnsOf(table.accelerations, table, "acceleration");
    faults_.throwIfAny();
    TrajectoryRows result;
    result.file = file_;
    result.hasVelocities = !table.velocities.empty();
    result.hasAccelerations = !table.accelerations.empty();
    result.timed = table.rows.front().time.has_value();
    result.isMessage = table.isMessage;
    result.notes = std::move(table.notes);
    checkFields(result, table.namesLine);
    RowFaults rowFaults(file_);
    for (const TrajectoryTable::Row& row : table.rows)
      rowFaults.row([&](FaultList& faults) {
        addRow(row, positions, velocities, accelerations, result, faults);
      });
    rowFaults.addTo(faults_);
    checkUnplanned(table, {positions, velocities, accelerations}, model_, result, faults_,
                   result.notes);
    checkStart(table, names_, model_, result, faults_, result.notes);
    if (table.rows.size() < 2)
      faults_.add(file_, table.rows.front().line,
                  "the trajectory has one row; it needs two or more (corridor check --states "
                  "tests single states)");
    faults_.throwIfAny();
    noteStart(result);
    return result;
  }

 private:
  /// The meaning of each column of a table.
  using Columns = std::vector<Meaning>;

  /// Returns the meanings of names. Adds faults for unknown, repeated and missing names.
  Columns columnsOf(const std::vector<std::string>& given, const TrajectoryTable& table,
                    const std::string& quantity) {
    const auto fault = [&](const std::string& text) { faults_.add(file_, table.namesLine, text); };
    const std::string what = quantity == "position" ? "" : quantity + " of ";
    Columns columns;
    for (const std::string& name : given) {
      const auto meaning = names_.find(name);
      if (const std::string several = names_.ambiguous(name); !several.empty())
        fault("more than one robot has the joint " + quotedWord(name) + "; write " + several);
      else if (!meaning)
        fault("the robot has no joint " + quotedWord(name) + didYouMean(name, names_.known()) +
              knownWords(names_.known()));
      else if (std::find(columns.begin(), columns.end(), *meaning) != columns.end())
        fault(what + quotedWord(name) + " is there twice");
      columns.push_back(meaning.value_or(Meaning{Meaning::Kind::other, 0, 0}));
    }
    if (given.empty() || faults_.size() > 0) return columns;
    std::vector<std::string> missing;
    const std::vector<std::string> numbers = names_.numbers();
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const bool has = std::find(columns.begin(), columns.end(),
                                 Meaning{Meaning::Kind::number, i, 0}) != columns.end();
      const bool isRotation = isOfRotation(i);
      if (quantity != "position" && isRotation && has)
        fault(what + quotedWord(numbers[i]) +
              ": a rotation has none here: it goes by slerp from row to row; leave it out");
      if (!has && !(quantity != "position" && isRotation)) missing.push_back(numbers[i]);
    }
    if (!missing.empty())
      fault(quantity == "position"
                ? "there is no column for " + joinedFirst(missing) +
                      "; all joints that are planned for need one"
                : "there is no " + quantity + " of " + joinedFirst(missing) +
                      "; give it for all joints that are planned for, or for none");
    return columns;
  }

  bool isOfRotation(std::size_t number) const {
    return std::any_of(model_.space.coordinates().begin(), model_.space.coordinates().end(),
                       [&](const Coordinate& c) {
                         return c.kind == Coordinate::Kind::rotation && c.first <= number &&
                                number < c.first + 4;
                       });
  }

  void checkFields(const TrajectoryRows& rows, int line) {
    if (rows.hasVelocities && !rows.timed)
      faults_.add(file_, line,
                  "there are velocities, but no times; add a column time, or leave the velocities "
                  "out");
    if (rows.hasAccelerations && !rows.hasVelocities)
      faults_.add(file_, line,
                  "there are accelerations, but no velocities; add the velocities, or leave the "
                  "accelerations out");
  }

  Configuration numbersOf(const std::vector<double>& values, const Columns& columns) const {
    Configuration q = Configuration::Zero(static_cast<Eigen::Index>(model_.space.size()));
    for (std::size_t i = 0; i < columns.size(); ++i)
      if (columns[i].kind == Meaning::Kind::number)
        q[static_cast<Eigen::Index>(columns[i].index)] = values[i];
    return q;
  }

  void addRow(const TrajectoryTable::Row& row, const Columns& positions, const Columns& velocities,
              const Columns& accelerations, TrajectoryRows& result, FaultList& faults) const {
    TrajectoryRow made;
    made.line = row.line;
    made.time = row.time.value_or(0);
    made.positions = numbersOf(row.positions, positions);
    if (!velocities.empty()) made.velocities = numbersOf(row.velocities, velocities);
    if (!accelerations.empty()) made.accelerations = numbersOf(row.accelerations, accelerations);
    if (!model_.space.isFinite(made.positions))
      faults.add(file_, row.line, "a quaternion of zeros is no rotation");
    if (result.timed && !result.rows.empty() && !(made.time > result.rows.back().time))
      faults.add(file_, row.line,
                 "the time " + shortest(made.time) + " s is not after that of the row before, " +
                     shortest(result.rows.back().time) + " s; times must ascend");
    result.rows.push_back(std::move(made));
  }

  void noteStart(TrajectoryRows& result) const {
    if (result.isMessage && result.timed && result.rows.front().time > 0)
      result.notes.push_back(
          {file_ + ": the first point is at " + shortest(result.rows.front().time) +
               " s: a controller moves there from the robot's state at 0 s, and this motion is not "
               "verified",
           NoteWeight::coverage});
  }

  std::string file_;
  const Model& model_;
  const JointNames& names_;
  FaultList faults_;
};

}  // namespace

TrajectoryFormat trajectoryFormatOf(std::string_view text) {
  text = withoutByteOrderMark(text);
  std::string_view rest = text;
  if (!isYamlLine(nextLine(rest))) return TrajectoryFormat::rows;
  if (text.substr(0, 4096).find("corridor-solution") != std::string_view::npos)
    return TrajectoryFormat::solution;
  for (const std::string_view key : {"format:", "path:"})
    for (std::size_t at = text.find(key); at != std::string_view::npos; at = text.find(key, at + 1))
      if (at == 0 || text[at - 1] == '\n') return TrajectoryFormat::solution;
  return TrajectoryFormat::message;
}

std::string readMotionText(const std::filesystem::path& file, const std::string& what) {
  std::error_code none;
  if (file != "-" && !std::filesystem::is_fifo(file, none)) return readTextFile(file, what);
  std::string text = readTextStream(file, what);
  if (text.size() > kMostDocumentBytes)
    throw InputError(Fault{file.string(), 0, "is larger than 256 MiB, the limit for " + what});
  return text;
}

TrajectoryRows readTrajectory(const std::string& file, const std::string& text,
                              const Model& model) {
  const JointNames names(model);
  return RowMaker(file, model, names)
      .make(trajectoryFormatOf(text) == TrajectoryFormat::rows ? readCsvTable(file, text, names)
                                                               : readMessageTable(file, text));
}

}  // namespace corridor
