#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "collision/core/fault_list.h"
#include "planner/import/moveit_poses.h"
#include "planner/model/model.h"
#include "planner/robot/note.h"

/// The steps between the text of a trajectory file and its `TrajectoryRows`.
namespace corridor {

/// The names of joints in trajectory files, and what they mean in a model.
class JointNames {
 public:
  struct Meaning {
    enum class Kind {
      number,  ///< a component of a Configuration
      held,    ///< a single joint that is not planned for
      mimic,   ///< a joint that follows another joint
      other    ///< a joint that has no value of its own here: fixed, or a pose that is held
    };
    Kind kind = Kind::number;
    /// `number`: index into a Configuration; other kinds: index of the joint in its robot.
    std::size_t index = 0;
    std::size_t robot = 0;  ///< index into Model::robots; unused for `number`
    bool operator==(const Meaning&) const = default;
  };

  explicit JointNames(const Model& model);
  /// Returns the meaning of a name. A name without the robot's name has a meaning if only one robot
  /// has such a joint.
  std::optional<Meaning> find(const std::string& name) const;
  /// If a name is ambiguous, returns the full names that it may stand for ("left/pan or
  /// right/pan"); else "".
  std::string ambiguous(const std::string& name) const;
  const std::vector<std::string>& known() const { return known_; }
  /// Returns the names of the components of a Configuration, in their order.
  std::vector<std::string> numbers() const {
    return {known_.begin(), known_.begin() + static_cast<std::ptrdiff_t>(numberCount_)};
  }

 private:
  std::map<std::string, Meaning> meanings_;
  std::map<std::string, std::vector<std::string>> short_;  // full names, by the short name
  std::vector<std::string> known_;  // full names; those of kind `number` come first
  std::size_t numberCount_ = 0;
};

/// A trajectory file as it is written: names, and rows of numbers.
struct TrajectoryTable {
  struct Row {
    int line = 0;
    std::optional<double> time;
    std::vector<double> positions, velocities, accelerations;
  };
  /// The state from which a message says that the robot starts: `trajectory_start` of MoveIt.
  struct Start {
    std::string path;  ///< for messages
    int line = 0;
    std::map<std::string, double> values;  ///< by the joints' names
    std::vector<MessagePose> poses;
  };
  int namesLine = 0;  ///< the line of the names; 0: the file has no names, and its columns are the
                      ///< components of a Configuration
  /// The name of each value of a row. If a table has no velocities, the list of their names is
  /// empty; the same holds for accelerations.
  std::vector<std::string> positions, velocities, accelerations;
  std::vector<Row> rows;
  std::optional<Start> start;
  bool isMessage = false;
  std::vector<Note> notes;
};

// Both readers throw an InputError with all faults of the header, and those of the first faulty row
// (row_faults.h).
/// Reads rows of numbers, with or without a header.
TrajectoryTable readCsvTable(const std::string& file, const std::string& text,
                             const JointNames& names);
/// Reads a JointTrajectory of ROS.
TrajectoryTable readMessageTable(const std::string& file, const std::string& text);

/// The quantity of a column of a table.
enum class ColumnQuantity { time, position, velocity, acceleration, ignored };

/// What a column's name means.
struct TableColumn {
  ColumnQuantity quantity = ColumnQuantity::position;
  std::string joint;
};
/// Returns the meaning of a column's name. If the joint is unknown, the quantity is position.
TableColumn columnOf(const std::string& name, const JointNames& names);

}  // namespace corridor
