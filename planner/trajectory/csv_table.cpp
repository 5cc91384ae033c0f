#include <algorithm>
#include <array>
#include <utility>

#include "collision/core/spelling.h"
#include "planner/problem/number_text.h"
#include "planner/problem/table_lines.h"
#include "planner/trajectory/row_faults.h"
#include "planner/trajectory/trajectory_table.h"

namespace corridor {
namespace {

using Quantity = ColumnQuantity;
using Column = TableColumn;

/// The words in a column's name that say which quantity the column has, as in pan_velocity,
/// pan.vel, vel_pan, velocity/pan.
struct QuantityWord {
  const char* word;
  Quantity quantity;
};
constexpr std::array kQuantityWords{QuantityWord{"position", Quantity::position},
                                    QuantityWord{"pos", Quantity::position},
                                    QuantityWord{"velocity", Quantity::velocity},
                                    QuantityWord{"vel", Quantity::velocity},
                                    QuantityWord{"acceleration", Quantity::acceleration},
                                    QuantityWord{"accel", Quantity::acceleration},
                                    QuantityWord{"acc", Quantity::acceleration},
                                    QuantityWord{"effort", Quantity::ignored},
                                    QuantityWord{"torque", Quantity::ignored}};

}  // namespace

TableColumn columnOf(const std::string& name, const JointNames& names) {
  const auto isJoint = [&](const std::string& joint) {
    return names.find(joint) || !names.ambiguous(joint).empty();
  };
  if (isJoint(name)) return {Quantity::position, name};
  if (name == "time" || name == "t" || name == "time_from_start") return {Quantity::time, name};
  for (const auto& [text, quantity] : kQuantityWords) {
    const std::string word = text;
    if (name.size() < word.size() + 2) continue;
    for (const char separator : {'_', '.', '/'}) {
      if (name.ends_with(separator + word)) {
        const std::string joint = name.substr(0, name.size() - word.size() - 1);
        if (isJoint(joint)) return {quantity, joint};
      }
      if (name.starts_with(word + separator)) {
        const std::string joint = name.substr(word.size() + 1);
        if (isJoint(joint)) return {quantity, joint};
      }
    }
  }
  return {Quantity::position, name};
}

namespace {

bool isKnown(const std::string& name, const JointNames& names) {
  const Column column = columnOf(name, names);
  return column.quantity != Quantity::position || names.find(column.joint) ||
         !names.ambiguous(column.joint).empty();
}

/// Returns the unit other than rad, m and s that a name states: pan_deg, pan(deg), [deg]. Else "".
std::string unitIn(const std::string& name) {
  const std::string unit = otherUnit(name);
  return unit.empty() ? otherUnit(name.substr(name.find_last_of("_.-/") + 1)) : unit;
}

class CsvReader {
 public:
  CsvReader(const std::string& file, const JointNames& names)
      : names_(names), file_(file), faults_(file), rowFaults_(file) {}

  TrajectoryTable read(const std::string& text) {
    TableLines lines(file_, text, names_.numbers(),
                     [this](const std::string& word) { return isKnown(word, names_); });
    while (lines.next()) {
      if (lines.isHeader()) {
        readHeader(lines.words(), lines.number());
        continue;
      }
      if (columns_.empty())
        for (const std::string& name : names_.numbers()) add({Quantity::position, name});
      rowFaults_.row([&](FaultList& faults) { readRow(lines.words(), lines.number(), faults); });
    }
    rowFaults_.addTo(faults_);
    if (auto note = lines.note()) table_.notes.push_back(std::move(*note));
    if (table_.rows.empty() && faults_.size() == 0) faults_.add(file_, 0, "has no row of numbers");
    faults_.throwIfAny();
    return std::move(table_);
  }

 private:
  void add(const Column& column) {
    columns_.push_back(column);
    switch (column.quantity) {
      case Quantity::position:
        return table_.positions.push_back(column.joint);
      case Quantity::velocity:
        return table_.velocities.push_back(column.joint);
      case Quantity::acceleration:
        return table_.accelerations.push_back(column.joint);
      case Quantity::time:
      case Quantity::ignored:
        return;
    }
  }

  void readHeader(const std::vector<std::string>& words, int line) {
    table_.namesLine = line;
    std::string time;
    std::vector<std::string> ignored;
    for (const std::string& word : words) {
      const Column column = columnOf(word, names_);
      add(column);
      if (const std::string unit = isKnown(word, names_) ? "" : unitIn(word); !unit.empty())
        faults_.add(file_, line,
                    "the column " + quotedWord(word) + " says " + quotedWord(unit) +
                        ", but the numbers are read in rad, m and s; convert it, and name it by "
                        "its joint only");
      if (column.quantity == Quantity::ignored) ignored.push_back(word);
      if (column.quantity != Quantity::time) continue;
      if (!time.empty())
        faults_.add(file_, line, "the header has two columns of times: " + time + " and " + word);
      time = word;
    }
    faults_.throwIfAny();
    if (!ignored.empty())
      table_.notes.push_back({file_ + ": not used: " + joinedFirst(ignored), NoteWeight::detail});
  }

  void readRow(const std::vector<std::string>& words, int line, FaultList& faults) {
    if (words.size() != columns_.size()) {
      const std::string has = counted(words.size());
      faults.add(file_, line,
                 table_.namesLine == 0
                     ? "a row has " + counted(columns_.size()) + " (" +
                           joinedFirst(table_.positions) + "), not " +
                           std::to_string(words.size()) +
                           "; if there are times or velocities, the first line must name the "
                           "columns"
                     : "the row has " + has + ", but the header names " +
                           std::to_string(columns_.size()) + " columns");
      return;
    }
    TrajectoryTable::Row row;
    row.line = line;
    for (std::size_t i = 0; i < words.size(); ++i) {
      double value = 0;
      const Quantity quantity = columns_[i].quantity;
      if (quantity == Quantity::ignored) continue;
      if (const std::string wrong = parseNumber(words[i], Range::Any, value); !wrong.empty()) {
        const std::string column =
            quantity == Quantity::time ? "time" : quotedWord(columns_[i].joint);
        faults.add(file_, line, column + ": " + wrong);
        return;
      }
      if (quantity == Quantity::time) row.time = value;
      if (quantity == Quantity::position) row.positions.push_back(value);
      if (quantity == Quantity::velocity) row.velocities.push_back(value);
      if (quantity == Quantity::acceleration) row.accelerations.push_back(value);
    }
    table_.rows.push_back(std::move(row));
  }

  static std::string counted(std::size_t count) {
    return std::to_string(count) + " number" + (count == 1 ? "" : "s");
  }

  const JointNames& names_;
  std::string file_;
  FaultList faults_;
  RowFaults rowFaults_;
  TrajectoryTable table_;
  std::vector<Column> columns_;
};

}  // namespace

TrajectoryTable readCsvTable(const std::string& file, const std::string& text,
                             const JointNames& names) {
  return CsvReader(file, names).read(text);
}

}  // namespace corridor
