#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>

#include "planner/import/moveit_state.h"
#include "planner/problem/yaml_ledger.h"
#include "planner/problem/yaml_reader.h"
#include "planner/problem/yaml_value.h"
#include "planner/trajectory/row_faults.h"
#include "planner/trajectory/trajectory_table.h"

namespace corridor {
namespace {

/// The fields of ROS and MoveIt messages that may contain a JointTrajectory, directly or in one
/// another.
constexpr std::array kWrappers{"joint_trajectory",    "trajectory", "planned_trajectory",
                               "robot_trajectory",    "goal",       "result",
                               "motion_plan_response"};
/// The fields of these messages that move nothing.
constexpr std::array<std::string_view, 14> kHarmless{"header",
                                                     "goal_id",
                                                     "status",
                                                     "model_id",
                                                     "group_name",
                                                     "planning_time",
                                                     "processing_time",
                                                     "description",
                                                     "controller_names",
                                                     "goal_tolerance",
                                                     "component_goal_tolerance",
                                                     "goal_time_tolerance",
                                                     "request_id",
                                                     "display_trajectory_id"};

const MapKeys kTrajectory{{"header", "joint_names", "points"}, {}};
const MapKeys kPoint{
    {"positions", "velocities", "accelerations", "effort", "efforts", "time_from_start"}, {}};
const MapKeys kDuration{{"sec", "nanosec", "secs", "nsecs"}, {}};
constexpr WholeRange kSeconds{0, 4'294'967'295, "0 to 2^32 - 1"};
constexpr WholeRange kWithinSecond{0, 999'999'999, "0 to 999999999"};

bool hasPoints(const YamlValue& map) {
  for (const YamlValue::Entry& entry : map.entries)
    if (entry.key == "points") return !entry.value.items.empty();
  return false;
}

/// Returns whether a trajectory of poses has anything that could be a point: in `points` of a map,
/// or anything at all in another value.
bool movesPoses(const YamlValue& poses) {
  const auto isNothing = [](const YamlValue& value) {
    return value.items.empty() && value.entries.empty() && value.text.empty();
  };
  if (poses.kind != YamlValue::Kind::Map) return !isNothing(poses);
  for (const YamlValue::Entry& entry : poses.entries)
    if (entry.key == "points" && !isNothing(entry.value)) return true;
  return false;
}

/// The messages in a document.
struct Messages {
  std::vector<const YamlValue*> trajectories;  // all maps that are joint trajectories
  std::vector<MoveitState> starts;
};

/// Adds a note if the message has an error code other than success: of a planner of MoveIt
/// (`{val: 1}` is success) or of a controller (0 is success).
void noteFailure(const YamlMap& map, YamlSource& source) {
  const YamlValue* code = map.find("error_code");
  if (!code) return;
  std::string path = map.pathOf("error_code");
  const bool isMoveit = code->kind == YamlValue::Kind::Map;
  if (isMoveit) {
    const YamlMap inner(*code, path, nullptr, source);
    inner.ignore({"message", "source"});  // of ROS 2
    path = inner.pathOf("val");
    code = inner.find("val");
  }
  if (!code || code->kind == YamlValue::Kind::Null) return;
  const std::string text = code->kind == YamlValue::Kind::Scalar ? code->text : described(*code);
  if (text.empty() || text == "0" || (isMoveit && text == "1")) return;
  source.notes.push_back({source.file + ": " + path + ": " + text +
                              " is not success; the trajectory is judged as it stands",
                          NoteWeight::coverage});
}

/// Adds the joint trajectories and the start states in `value` to `found`. Adds a fault for each
/// trajectory of poses, and notes on what a controller does beyond the trajectory.
void collectMessages(const YamlValue& value, const std::string& path, Messages& found,
                     YamlSource& source) {
  for (const YamlValue& item : value.items) collectMessages(item, path + "[]", found, source);
  if (hasKey(value, "points") || hasKey(value, "joint_names")) {
    found.trajectories.push_back(&value);
    return;
  }
  if (value.kind != YamlValue::Kind::Map) return;
  const YamlMap map(value, path, nullptr, source);
  for (const std::string_view key : kHarmless) map.ignore({key});
  for (const char* const key : {"multi_dof_joint_trajectory", "multi_dof_trajectory"})
    if (const YamlValue* const poses = map.find(key)) {
      if (movesPoses(*poses)) {
        markRead(*poses);
        map.fault(key,
                  "trajectories of poses are not read from messages; write rows of numbers (CSV)");
      } else if (poses->kind == YamlValue::Kind::Map) {  // other keys are left to the note on them
        YamlMap(*poses, map.pathOf(key), nullptr, source)
            .ignore({"header", "joint_names", "points"});
      }
    }
  for (const char* const key : {"path_tolerance", "component_path_tolerance"})
    if (!isEmpty(map, key)) {
      markRead(*map.find(key));
      source.notes.push_back({source.file + ": " + map.pathOf(key) +
                                  ": is not used; a proof covers the problem's tube (key tube)",
                              NoteWeight::coverage});
    }
  if (const YamlValue* const executed = map.find("executed_trajectory")) {
    markRead(*executed);
    source.notes.push_back({source.file + ": " + map.pathOf("executed_trajectory") +
                                ": is not read; to verify it, save it as a file of its own",
                            NoteWeight::coverage});
  }
  noteFailure(map, source);
  if (auto start = readMoveitState(map, "trajectory_start"))
    found.starts.push_back(std::move(*start));
  for (const char* const key : kWrappers)
    if (const YamlValue* const inner = map.find(key))
      collectMessages(*inner, map.pathOf(key), found, source);
}

/// Returns the only trajectory among those of a document, or nullptr if a fault was added.
const YamlValue* trajectoryIn(std::vector<const YamlValue*> found, YamlSource& source) {
  if (source.faults.size() > 0) return nullptr;
  const auto empty = [](const YamlValue* map) { return !hasPoints(*map); };
  if (found.size() > 1 && !std::all_of(found.begin(), found.end(), empty))
    std::erase_if(found, empty);
  if (found.empty())
    source.fault(0,
                 "has no trajectory: joint_names and points are needed, in a JointTrajectory or in "
                 "a message that has one (joint_trajectory, trajectory, planned_trajectory)");
  if (found.size() > 1)
    source.fault(found[1]->line,
                 "has " + std::to_string(found.size()) + " trajectories; keep one of them");
  return found.size() == 1 ? found.front() : nullptr;
}

/// Returns the seconds of a duration: a number, {sec, nanosec} or {secs, nsecs}. Below 2^53 ns (104
/// days), the result is the double nearest to the exact duration.
std::optional<double> readTime(const YamlMap& point) {
  const YamlValue* const time = point.find("time_from_start");
  if (!time) return std::nullopt;
  if (time->kind != YamlValue::Kind::Map) return point.number("time_from_start");
  const YamlMap map(*time, point.pathOf("time_from_start"), &kDuration, point.source());
  const bool isRos1 = map.find("secs") || map.find("nsecs");
  if (isRos1 && (map.find("sec") || map.find("nanosec"))) {
    map.fault("sec", "secs and nsecs are given, too; keep one pair");
    return std::nullopt;
  }
  if (map.empty()) {
    point.fault("time_from_start", "sec and nanosec are needed");
    return std::nullopt;
  }
  const std::size_t faults = point.source().faults.size();
  const std::uint64_t seconds = map.wholeNumber(isRos1 ? "secs" : "sec", kSeconds).value_or(0),
                      rest =
                          map.wholeNumber(isRos1 ? "nsecs" : "nanosec", kWithinSecond).value_or(0);
  if (point.source().faults.size() > faults) return std::nullopt;
  return static_cast<double>(seconds * 1'000'000'000 + rest) / 1e9;
}

/// Returns the numbers of a list. If the key is absent or its list is empty, the result is empty.
/// Returns nullopt if a fault was added.
std::optional<std::vector<double>> readList(const YamlMap& point, const char* key,
                                            std::size_t count) {
  if (isEmpty(point, key)) return std::vector<double>();
  for (const YamlValue& item : point.find(key)->items)
    if (item.text == "...") {
      point.fault(key, "the list is cut off (...); record it by ros2 topic echo --full-length");
      return std::nullopt;
    }
  return point.numbers(key, count);
}

class PointReader {
 public:
  PointReader(std::vector<std::string> names, const std::string& file) : file_(file) {
    table_.isMessage = true;
    table_.positions = std::move(names);
  }

  void read(const YamlValue& value, std::size_t index, FaultList& faultsOfRow) {
    const std::string path = "points[" + std::to_string(index) + "]";
    YamlSource source{file_, faultsOfRow, {}};
    const YamlMap point(value, path, &kPoint, source);
    point.ignore({"effort", "efforts"});
    TrajectoryTable::Row row;
    row.line = value.line;
    const std::size_t count = table_.positions.size();
    auto positions = readList(point, "positions", count);
    auto velocities = readList(point, "velocities", count);
    auto accelerations = readList(point, "accelerations", count);
    row.time = readTime(point);
    if (faultsOfRow.size() > 0 || value.kind != YamlValue::Kind::Map) return;
    if (positions->empty()) return point.fault("positions", "are missing");
    row.positions = std::move(*positions);
    row.velocities = std::move(*velocities);
    row.accelerations = std::move(*accelerations);
    if (!table_.rows.empty() && mixed(point, row)) return;
    table_.rows.push_back(std::move(row));
  }

  TrajectoryTable take() {
    if (table_.rows.empty()) return std::move(table_);
    if (!table_.rows.front().velocities.empty()) table_.velocities = table_.positions;
    if (!table_.rows.front().accelerations.empty()) table_.accelerations = table_.positions;
    const bool atOnce = std::all_of(table_.rows.begin(), table_.rows.end(),
                                    [](const auto& row) { return row.time == 0.0; });
    if (atOnce && table_.rows.size() > 1 && table_.velocities.empty()) {
      for (TrajectoryTable::Row& row : table_.rows) row.time.reset();
      table_.notes.push_back({file_ + ": time_from_start is 0 at all points: the points are a path "
                                      "without times",
                              NoteWeight::motion});
    }
    return std::move(table_);
  }

 private:
  /// Returns whether the row has other fields than the first row; if so, adds a fault.
  bool mixed(const YamlMap& point, const TrajectoryTable::Row& row) const {
    const TrajectoryTable::Row& first = table_.rows.front();
    const auto differs = [&](const char* what, bool has, bool firstHas) {
      if (has == firstHas) return false;
      point.source().fault(row.line,
                           point.pathOf(what) + (has ? ": are given here" : ": are missing here") +
                               ", but the first point has " + (firstHas ? "them" : "none") +
                               "; give them for all points or for none");
      return true;
    };
    return differs("velocities", !row.velocities.empty(), !first.velocities.empty()) ||
           differs("accelerations", !row.accelerations.empty(), !first.accelerations.empty()) ||
           differs("time_from_start", row.time.has_value(), first.time.has_value());
  }

  std::string file_;
  TrajectoryTable table_;
};

}  // namespace

TrajectoryTable readMessageTable(const std::string& file, const std::string& text) {
  const YamlValue document = parseYaml(file, text);
  FaultList faults(file);
  YamlSource source{file, faults, {}};
  Messages messages;
  collectMessages(document, "", messages, source);
  const YamlValue* const found = trajectoryIn(messages.trajectories, source);
  if (messages.starts.size() > 1)
    source.fault(messages.starts[1].line, "has " + std::to_string(messages.starts.size()) +
                                              " states trajectory_start; keep one of them");
  faults.throwIfAny();
  const YamlMap map(*found, "", &kTrajectory, source);
  map.ignore({"header"});
  const YamlValue* const names = map.require("joint_names", "such as [pan, lift]");
  const YamlValue* const points = map.require("points", "the rows of the trajectory");
  const auto words =
      names ? readWords(*names, "such as [pan, lift]", "joint_names", source) : std::nullopt;
  if (words && words->empty()) map.fault("joint_names", "has no name");
  if (points && points->items.empty()) map.fault("points", "has no point");
  faults.throwIfAny();
  assert(names && words && points);  // what is missing is among the faults
  PointReader reader(*words, file);
  RowFaults rowFaults(file);
  for (std::size_t i = 0; i < points->items.size(); ++i)
    rowFaults.row([&](FaultList& own) { reader.read(points->items[i], i, own); });
  rowFaults.addTo(faults);
  faults.throwIfAny();
  TrajectoryTable table = reader.take();
  table.namesLine = names->line;
  if (!messages.starts.empty())
    table.start = {messages.starts.front().path, messages.starts.front().line,
                   std::move(messages.starts.front().values),
                   std::move(messages.starts.front().poses)};
  addAll(source.notes, table.notes);
  addAll(notesOnUnread(document, file, DefaultValues::sayNothing), table.notes);
  return table;
}

}  // namespace corridor
