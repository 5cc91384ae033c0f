#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "planner/model/model.h"
#include "planner/robot/note.h"

namespace corridor {

/// A row of a trajectory file: the state of the robot at one time.
struct TrajectoryRow {
  int line = 0;     ///< the line in the file, counted from 1
  double time = 0;  ///< seconds; meaningless if the file has no times
  /// The components of a configuration, in the order of the space (`numberNames`): m, rad,
  /// quaternions as (x, y, z, w). The values are those in the file. Angles are literal: they are
  /// never reduced to one revolution.
  Configuration positions;
  /// In m/s and rad/s, and in m/s² and rad/s². Each is empty if the file does not contain it. The
  /// components of a rotation are 0, because a file can't give them.
  Configuration velocities, accelerations;
};

/// The content of a trajectory file: configurations of a problem, row by row.
/// planner/trajectory/README.md lists the formats.
struct TrajectoryRows {
  std::string file;                 ///< for messages
  std::vector<TrajectoryRow> rows;  ///< two or more
  bool timed = false;               ///< every row has a time; the times are strictly ascending
  /// A file with accelerations has velocities, too.
  bool hasVelocities = false, hasAccelerations = false;
  /// The file is a message for a controller. A controller begins at time 0, in the robot's state at
  /// that time.
  bool isMessage = false;
  std::vector<Note> notes;  ///< on values that are not used
};

/// The kinds of files that describe a motion.
enum class TrajectoryFormat {
  solution,  ///< a solution file of Corridor (planner/solve/solution.h)
  rows,      ///< rows of numbers (CSV)
  message    ///< a JointTrajectory of ROS, as YAML or JSON, alone or in a message of MoveIt
};
/// Recognises the format of a text by its content. Every text has a format: the reader of this
/// format then reports the text's faults.
TrajectoryFormat trajectoryFormatOf(std::string_view text);

/// Returns the text of a file that describes a motion; "-" is the standard input.
/// @param what the kind of file for messages: "a trajectory".
/// @throws InputError for the same reasons as readTextFile and readTextStream
/// (collision/core/read_file.h).
std::string readMotionText(const std::filesystem::path& file, const std::string& what);

/// Reads a trajectory of all joints that the model plans for.
/// - The names in the file are those of the space (`numberNames`), in any order. The robot's name
///   before them ("left/pan") may be left out if only one robot has the joint.
/// - A joint that is held must stay at the value at which it is held, and a joint that mimics
///   another must stay on its rule, up to rounding, on the whole curve between the rows. Otherwise
///   the file is refused: a proof would be about another robot (unplanned_columns.h).
/// - If a message has a start state (`trajectory_start`), the first row must be this state, and no
///   object may be attached to the robot.
/// - Each other value of a message is used, or a note says that it is not. Values that move nothing
///   have no note (efforts, time stamps, identifiers).
/// @param file the name for messages.
/// @param text a text of the format `rows` or `message`.
/// @throws InputError with all faults; from the rows, only the faults of the first faulty row.
TrajectoryRows readTrajectory(const std::string& file, const std::string& text, const Model& model);

}  // namespace corridor
