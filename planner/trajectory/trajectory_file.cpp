#include "planner/trajectory/trajectory_file.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "collision/core/error.h"
#include "collision/core/read_file.h"
#include "collision/core/shortest.h"
#include "collision/core/spelling.h"
#include "planner/problem/urdf_robot.h"
#include "planner/robot/joint_types.h"
#include "planner/trajectory/row_faults.h"
#include "planner/trajectory/trajectory_table.h"

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
    checkOthers(positions, table, result);
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

  /// Returns the value of the joint that a mimic joint follows, in a row with these positions: the
  /// held value, or the planned joint's position. Returns nullopt if the joint has neither.
  std::optional<double> leaderValue(const ModelRobot& robot, std::size_t joint,
                                    const Configuration& positions) const {
    if (const auto held = robot.held.find(joint); held != robot.held.end()) return held->second;
    for (std::size_t k = 0; k < robot.planned.size(); ++k)
      if (robot.planned[k] == joint) {
        const std::size_t coordinate = robot.plannedJoints[k].coordinate;
        return positions[static_cast<Eigen::Index>(model_.space.coordinates()[coordinate].first)];
      }
    return std::nullopt;
  }

  /// Checks the columns of joints that are not planned for.
  void checkOthers(const Columns& columns, const TrajectoryTable& table, TrajectoryRows& result) {
    std::vector<std::string> followers, fixed;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (columns[i].kind == Meaning::Kind::number) continue;
      const ModelRobot& robot = model_.robots[columns[i].robot];
      const JointModel& joint = robot.description.joints[columns[i].index];
      const std::string& name = table.positions[i];
      if (columns[i].kind == Meaning::Kind::other) {
        if (joint.type == JointType::fixed)
          fixed.push_back(name);
        else
          faults_.add(file_, table.namesLine,
                      quotedWord(name) + " is a " + nameOf(joint.type) +
                          " joint, and is not planned for; leave it out");
      } else if (columns[i].kind == Meaning::Kind::held) {
        checkHeld(robot.held.at(columns[i].index), name, joint.name, i, table);
      } else {
        followers.push_back(name);
        noteMimic(robot, *joint.mimic, name, i, table, result);
      }
    }
    if (!fixed.empty())
      result.notes.push_back(
          {file_ + ": not read: " + joinedFirst(fixed) + "; these joints are fixed",
           NoteWeight::detail});
    if (!followers.empty())
      result.notes.push_back({file_ + ": not read: " + joinedFirst(followers) +
                                  "; mimic joints follow the rule of the robot",
                              NoteWeight::detail});
  }

  void checkHeld(double held, const std::string& name, const std::string& joint, std::size_t column,
                 const TrajectoryTable& table) {
    double lower = HUGE_VAL, upper = -HUGE_VAL;
    const TrajectoryTable::Row* first = nullptr;  // the first row whose value is not the held value
    for (const TrajectoryTable::Row& row : table.rows) {
      const double value = row.positions[column];
      lower = std::min(lower, value), upper = std::max(upper, value);
      if (!first && std::abs(value - held) > limitSlack) first = &row;
    }
    if (!first) return;
    const std::string isHeld =
        quotedWord(name) + " is held at " + shortest(held) + " in the problem, but is ";
    if (upper - lower <= limitSlack)
      faults_.add(file_, first->line,
                  isHeld + shortest(first->positions[column]) +
                      " here: the proof would be about another robot; in the robot's file, write "
                      "hold: {" +
                      joint + ": " + shortest(first->positions[column]) + "}");
    else
      faults_.add(file_, first->line,
                  isHeld + shortest(lower) + " to " + shortest(upper) +
                      " in this file; plan for the joint (joints: in the robot's file), or leave "
                      "it out of the file and let margin cover its motion");
  }

  /// Adds a note if a mimic joint is off its rule.
  void noteMimic(const ModelRobot& robot, const Mimic& mimic, const std::string& name,
                 std::size_t column, const TrajectoryTable& table, TrajectoryRows& result) const {
    double largest = 0;
    int line = 0;
    for (std::size_t r = 0; r < table.rows.size(); ++r) {
      const auto leader = leaderValue(robot, mimic.joint, result.rows[r].positions);
      if (!leader) return;
      const double off =
          std::abs(table.rows[r].positions[column] - (mimic.multiplier * *leader + mimic.offset));
      if (off > largest) largest = off, line = table.rows[r].line;
    }
    if (largest > limitSlack)
      result.notes.push_back({file_ + ": " + quotedWord(name) + " is up to " + shortest(largest) +
                                  " off the rule by which it follows " +
                                  quotedWord(robot.description.joints[mimic.joint].name) +
                                  " (line " + std::to_string(line) + "); the proof is for the rule",
                              NoteWeight::coverage});
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
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // byte-order mark
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
  if (file != "-") return readTextFile(file, what);
  std::string text = readTextStream(file, what);
  if (text.size() > kMostDocumentBytes)
    throw InputError(Fault{"-", 0, "is larger than 256 MiB, the limit for " + what});
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
