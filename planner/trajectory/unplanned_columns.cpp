#include "planner/trajectory/unplanned_columns.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "collision/core/shortest.h"
#include "collision/core/spelling.h"
#include "planner/model/joint_rule.h"
#include "planner/problem/urdf_robot.h"
#include "planner/robot/joint_types.h"

namespace corridor {
namespace {

/// Returns what to do about a held joint for which a file has another value than the problem.
std::string howToHold(const JointModel& joint, double value) {
  return joint.lower == joint.upper
             ? "the limits of the joint are equal, so " + shortest(joint.lower) +
                   " is its only value"
             : "in the robot's file, write hold: {" + joint.name + ": " + shortest(value) + "}";
}

using Meaning = JointNames::Meaning;
using TableRow = TrajectoryTable::Row;

constexpr double kWholeTurn = 2 * std::numbers::pi;

/// A value of a joint and its derivatives by time.
struct JointState {
  double position = 0, velocity = 0, acceleration = 0;
};

/// Returns the state that a row requires of a joint by its rule.
JointState requiredState(const JointRule& rule, const TrajectoryRow& row) {
  JointState state{rule.at(row.positions), 0, 0};
  if (rule.leader < 0) return state;
  // The sums with 0 turn -0 into 0, for messages.
  if (row.velocities.size() > 0) state.velocity = rule.multiplier * row.velocities[rule.leader] + 0;
  if (row.accelerations.size() > 0)
    state.acceleration = rule.multiplier * row.accelerations[rule.leader] + 0;
  return state;
}

/// The columns of one joint; absent quantities have no column.
struct JointColumns {
  Meaning meaning;
  std::string name;
  std::optional<std::size_t> position, velocity, acceleration;
};

class UnplannedCheck {
 public:
  UnplannedCheck(const TrajectoryTable& table, const Model& model, const TrajectoryRows& rows,
                 FaultList& faults, std::vector<Note>& notes)
      : table_(table), model_(model), rows_(rows), faults_(faults), notes_(notes) {}

  void run(const TableColumns& columns) {
    std::vector<JointColumns> joints;
    collect(columns.positions, table_.positions, &JointColumns::position, joints);
    collect(columns.velocities, table_.velocities, &JointColumns::velocity, joints);
    collect(columns.accelerations, table_.accelerations, &JointColumns::acceleration, joints);
    std::vector<std::string> followers, fixed;
    for (const JointColumns& joint : joints) {
      const JointType type = jointOf(joint.meaning).type;
      if (joint.meaning.kind == Meaning::Kind::mimic)
        followers.push_back(joint.name);
      else if (joint.meaning.kind == Meaning::Kind::other && type == JointType::fixed)
        fixed.push_back(joint.name);
      if (joint.meaning.kind != Meaning::Kind::other)
        requireRule(joint);
      else if (type == JointType::fixed)
        requireRest(joint);
      else
        faults_.add(rows_.file, table_.namesLine,
                    quotedWord(joint.name) + " is a " + nameOf(type) +
                        " joint, and is not planned for; leave it out");
    }
    if (!fixed.empty())
      notes_.push_back(
          {rows_.file + ": not read: " + joinedFirst(fixed) + "; these joints are fixed",
           NoteWeight::detail});
    if (!followers.empty())
      notes_.push_back({rows_.file + ": not read: " + joinedFirst(followers) +
                            "; mimic joints follow the rule of the robot",
                        NoteWeight::detail});
  }

 private:
  const JointModel& jointOf(const Meaning& meaning) const {
    return model_.robots[meaning.robot].description.joints[meaning.index];
  }

  static void collect(const std::vector<Meaning>& columns, const std::vector<std::string>& names,
                      std::optional<std::size_t> JointColumns::*quantity,
                      std::vector<JointColumns>& joints) {
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (columns[i].kind == Meaning::Kind::number) continue;
      auto known = std::find_if(joints.begin(), joints.end(),
                                [&](const JointColumns& j) { return j.meaning == columns[i]; });
      if (known == joints.end())
        known = joints.insert(known, JointColumns{columns[i], names[i], {}, {}, {}});
      (*known).*quantity = i;
    }
  }

  /// Returns the state that the file gives to a joint in a row. Quantities without a column are
  /// those of `byDefault`.
  static JointState stateIn(const TableRow& row, const JointColumns& joint,
                            const JointState& byDefault) {
    JointState state = byDefault;
    if (joint.position) state.position = row.positions[*joint.position];
    if (joint.velocity) state.velocity = row.velocities[*joint.velocity];
    if (joint.acceleration) state.acceleration = row.accelerations[*joint.acceleration];
    return state;
  }

  /// Returns the longest time between a row and the rows before and after it, seconds; 0 if the
  /// rows have no times.
  double longestStep(std::size_t r) const {
    double step = 0;
    if (!rows_.timed) return step;
    if (r > 0) step = rows_.rows[r].time - rows_.rows[r - 1].time;
    if (r + 1 < rows_.rows.size())
      step = std::max(step, rows_.rows[r + 1].time - rows_.rows[r].time);
    return step;
  }

  /// Adds a fault for the first row in which a held or mimic joint leaves its required state.
  void requireRule(const JointColumns& joint) {
    const JointRule required = ruleOf(model_, joint.meaning.robot, joint.meaning.index);
    // The file may give a continuous joint as an angle that is full turns away. The number of turns
    // is that of the first row, so that a turn between two rows is a difference.
    double turns = 0;
    for (std::size_t r = 0; r < table_.rows.size(); ++r) {
      const JointState rule = requiredState(required, rows_.rows[r]),
                       given = stateIn(table_.rows[r], joint, rule);
      if (r == 0 && jointOf(joint.meaning).type == JointType::continuous)
        turns = kWholeTurn * std::round((given.position - rule.position) / kWholeTurn);
      const double off = std::abs(given.position - (rule.position + turns)),
                   speed = std::abs(given.velocity - rule.velocity),
                   growth = std::abs(given.acceleration - rule.acceleration), step = longestStep(r),
                   slack = equalUpToRounding(
                       std::max(std::abs(given.position),
                                std::max(step * std::abs(rule.velocity),
                                         step * step * std::abs(rule.acceleration))));
      if (off + step * speed + step * step * growth <= slack) continue;
      const bool isHeld = joint.meaning.kind == Meaning::Kind::held;
      if (isHeld && off > slack)
        faultHeld(joint, rule.position, r);
      else if (isHeld)
        faults_.add(rows_.file, table_.rows[r].line,
                    quotedWord(joint.name) + " is held at " + shortest(rule.position) +
                        " in the problem, but has " + derivativesText(given) +
                        " here, so it moves between the rows; " + kPlanOrLeaveOut);
      else
        faultMimic(joint, given, rule, off > slack, r);
      return;
    }
  }

  static std::string derivativesText(const JointState& state) {
    return state.velocity != 0 ? "the velocity " + shortest(state.velocity)
                               : "the acceleration " + shortest(state.acceleration);
  }

  void faultHeld(const JointColumns& joint, double held, std::size_t first) {
    double lower = HUGE_VAL, upper = -HUGE_VAL;
    for (const TableRow& row : table_.rows) {
      lower = std::min(lower, row.positions[*joint.position]);
      upper = std::max(upper, row.positions[*joint.position]);
    }
    const TableRow& row = table_.rows[first];
    const std::string isHeld =
        quotedWord(joint.name) + " is held at " + shortest(held) + " in the problem, but is ";
    if (lower == upper)
      faults_.add(rows_.file, row.line,
                  isHeld + shortest(lower) + " here: the proof would be about another robot; " +
                      howToHold(jointOf(joint.meaning), lower));
    else
      faults_.add(rows_.file, row.line,
                  isHeld + shortest(lower) + " to " + shortest(upper) + " in this file; " +
                      kPlanOrLeaveOut);
  }

  void faultMimic(const JointColumns& joint, const JointState& given, const JointState& rule,
                  bool isOff, std::size_t r) {
    const std::string leader = model_.robots[joint.meaning.robot]
                                   .description.joints[jointOf(joint.meaning).mimic->joint]
                                   .name;
    const std::string differs =
        isOff ? "is " + shortest(given.position) + " here, and " + shortest(rule.position)
        : given.velocity != rule.velocity ? "has the velocity " + shortest(given.velocity) +
                                                " here, and " + shortest(rule.velocity)
                                          : "has the acceleration " + shortest(given.acceleration) +
                                                " here, and " + shortest(rule.acceleration);
    faults_.add(rows_.file, table_.rows[r].line,
                quotedWord(joint.name) + " " + differs + " by the rule by which it follows " +
                    quotedWord(leader) +
                    ": the proof would be for the rule; leave its columns out if it follows the "
                    "rule, or plan for it (remove <mimic> from the URDF)");
  }

  /// Checks the columns of a fixed joint.
  void requireRest(const JointColumns& joint) {
    const auto faultAt = [&](const TableRow& row, const std::string& what) {
      faults_.add(rows_.file, row.line,
                  quotedWord(joint.name) + " is fixed in the URDF, but " + what +
                      "; leave its columns out, or give the joint its type in the URDF");
    };
    const TableRow& first = table_.rows.front();
    for (const TableRow& row : table_.rows) {
      const JointState state = stateIn(row, joint, {});
      if (joint.position && state.position != first.positions[*joint.position])
        return faultAt(row, "moves from " + shortest(first.positions[*joint.position]) + " to " +
                                shortest(state.position) + " in this file");
      if (state.velocity != 0 || state.acceleration != 0)
        return faultAt(row, "has " + derivativesText(state) + " here");
    }
    if (joint.position && first.positions[*joint.position] != 0)
      notes_.push_back({rows_.file + ": " + quotedWord(joint.name) + " is fixed in the URDF; its " +
                            "position here, " + shortest(first.positions[*joint.position]) +
                            ", is not used",
                        NoteWeight::coverage});
  }

  static constexpr const char* kPlanOrLeaveOut =
      "plan for the joint (joints: in the robot's file), or leave it out of the file and let "
      "margin cover its motion";

  const TrajectoryTable& table_;
  const Model& model_;
  const TrajectoryRows& rows_;
  FaultList& faults_;
  std::vector<Note>& notes_;
};

}  // namespace

void checkUnplanned(const TrajectoryTable& table, const TableColumns& columns, const Model& model,
                    const TrajectoryRows& rows, FaultList& faults, std::vector<Note>& notes) {
  UnplannedCheck(table, model, rows, faults, notes).run(columns);
}

void checkStart(const TrajectoryTable& table, const JointNames& names, const Model& model,
                const TrajectoryRows& rows, FaultList& faults, std::vector<Note>& notes) {
  if (!table.start) return;
  const TrajectoryTable::Start& start = *table.start;
  const TrajectoryRow& first = rows.rows.front();
  const auto fault = [&](const std::string& text) {
    faults.add(rows.file, start.line, start.path + ": " + text);
  };
  std::vector<std::string> unknown, near, fixed;
  for (const auto& [name, value] : start.values) {
    const auto meaning = names.find(name);
    if (const std::string several = names.ambiguous(name); !several.empty()) {
      fault("more than one robot has the joint " + quotedWord(name) + "; write " + several);
    } else if (!meaning) {
      unknown.push_back(name);
    } else if (meaning->kind == Meaning::Kind::number) {
      const auto index = static_cast<Eigen::Index>(meaning->index);
      double off = value - first.positions[index];
      for (const Coordinate& c : model.space.coordinates())
        if (c.first == meaning->index && c.kind == Coordinate::Kind::circle)
          off = std::remainder(off, kWholeTurn);
      if (std::abs(off) > limitSlack)
        fault(quotedWord(name) + " is " + shortest(value) + ", but the first point has " +
              shortest(first.positions[index]) +
              ": the motion between them is not in the file; begin the points at the start");
      else if (std::abs(off) > equalUpToRounding(value))
        near.push_back(name);
    } else if (meaning->kind != Meaning::Kind::other) {
      const double required = ruleOf(model, meaning->robot, meaning->index).at(first.positions);
      double off = value - required;
      const JointModel& joint = model.robots[meaning->robot].description.joints[meaning->index];
      if (joint.type == JointType::continuous) off = std::remainder(off, kWholeTurn);
      if (std::abs(off) <= equalUpToRounding(value)) continue;
      if (meaning->kind == Meaning::Kind::held)
        fault(quotedWord(name) + " is held at " + shortest(required) + " in the problem, but is " +
              shortest(value) + " here: the proof would be about another robot; " +
              howToHold(joint, value));
      else
        fault(quotedWord(name) + " is " + shortest(value) + ", and " + shortest(required) +
              " by the rule of this mimic joint: the proof would be for the rule; leave the value "
              "out if the joint follows the rule");
    } else if (value != 0) {
      fixed.push_back(name);
    }
  }
  for (const MessagePose& pose : start.poses)
    if (const auto conflict = conflictOf(pose, model, first.positions, "first point")) {
      if (conflict->isNear)
        near.push_back(pose.joint);
      else
        faults.add(rows.file, pose.line, conflict->text + "; " + conflict->fix);
    }
  if (!near.empty())
    notes.push_back({rows.file + ": " + start.path + ": " + joinedFirst(near) +
                         " of the start and of the first point differ by up to " +
                         shortest(limitSlack) + "; the motion between them is not verified",
                     NoteWeight::coverage});
  if (!fixed.empty())
    notes.push_back(
        {rows.file + ": " + start.path +
             ": not used, because the joints are fixed or need a pose: " + joinedFirst(fixed),
         NoteWeight::coverage});
  if (!unknown.empty())
    notes.push_back({rows.file + ": " + start.path + ": the robot has no joint " +
                         joinedFirst(unknown) + "; the values are not used",
                     NoteWeight::coverage});
}

}  // namespace corridor
