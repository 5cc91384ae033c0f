#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "collision/core/rigid_pose.h"
#include "collision/core/transform.h"
#include "collision/motion/motion_query.h"
#include "planner/checker/left_out.h"
#include "planner/problem/problem.h"
#include "planner/robot/configuration_space.h"
#include "planner/solve/verify_solution.h"

namespace corridor::app {

enum class Tone { plain, good, bad };

/// Prints results for people on stdout, as lines `key: value`, with colours if stdout is a
/// terminal. Prints nothing if `quiet` is set.
class ResultPrinter {
 public:
  explicit ResultPrinter(bool quiet) : quiet_(quiet) {}
  void line(std::string_view key, const std::string& value, Tone tone = Tone::plain) const;
  void blank() const;

 private:
  bool quiet_;
};

/// Returns the text of a JSON value, which is always valid: names of files may have bytes that are
/// not UTF-8, for which it has U+FFFD. @param indent  -1: one line
std::string jsonText(const nlohmann::ordered_json& json, int indent = 2);

/// Returns how far the tested pairs are proved to be apart, in millimetres.
std::string provedClearanceText(double metres);

/// Returns the margins of a task whose smallest margin was replaced: "0.003 to 0.004 m", or "" if
/// there is none.
std::string marginText(const Task& task, double margin);

/// Inserts `notes` before all notes in `to`.
inline void addFirst(const std::vector<Note>& notes, std::vector<Note>& to) {
  to.insert(to.begin(), notes.begin(), notes.end());
}

/// Returns the notes for people to read. Among notes that differ only in quoted names and in
/// numbers, only the first is returned. A remark such as "(and 3 similar notes…)" is appended to
/// this first note.
/// @param rest the end of this remark: how the user can list all notes.
std::vector<std::string> condensed(const std::vector<std::string>& notes,
                                   const std::string& rest = "; inspect --json lists all");

/// Prints the notes on stderr, condensed. @param rest as for `condensed`.
void printNotes(const std::vector<Note>& notes,
                const std::string& rest = "; inspect --json lists all");

/// Prints the faults on stderr, one a line, and then the notes on the part of the input that could
/// be read.
void printFaults(const InputError& error);

/// Prints a warning on stderr. Callers warn before they print results on stdout.
void warn(const std::string& text);

/// Reads the problem of a command. If the problem tests no pair of bodies, prints a warning before
/// any other output; the problem's `notes` contain the same warning. @throws InputError as
/// readProblem.
/// @param cache see `readProblem`.
Problem readProblemOf(const std::string& file, std::shared_ptr<FileCache> cache = nullptr);

/// Writes what a cache was offered. A command does this after it has given its answer. Prints the
/// cache's notes on stderr, unless `quiet` is set. @param cache may be null
void saveCache(FileCache* cache, bool quiet);
void printCacheNotes(const std::vector<std::string>& notes);

struct Verified {
  VerifyReport report;
  std::vector<std::string> warnings;  ///< already printed
};

/// Verifies a solution. If its digest differs from the problem's, prints a warning, and verifies
/// nothing unless `ignoreDigest` is set. Prints warnings if the solution claims more than is
/// verified.
Verified verifyWithWarning(const Problem& problem, const Solution& solution,
                           const std::string& problemFile, const std::string& solutionFile,
                           bool ignoreDigest);

/// Tests that a file can be written: its name is not that of a folder, its folder exists, and files
/// can be made in this folder. The last test is left out for a device or a pipe. Commands call this
/// before they spend time on the file's contents. Does nothing if no file is given.
/// @throws InputError, which names the option, if the file can't be written.
void requireWritable(const std::optional<std::string>& file, const char* option);

/// Tests that the file that will be written is none of the files `read`.
/// @param what the owner of these files, for the message: "the problem".
/// @throws InputError, which names the option, if one of these files would be overwritten.
void requireNotAnInput(const std::optional<std::string>& file, const char* option,
                       const std::vector<std::filesystem::path>& read, const std::string& what);

/// Returns the value with four significant digits, for people to read.
std::string rounded(double value);
std::string rounded(const Vec3& v, int dimension = 3);  ///< "[1, 2, 3]"; dimension 2: "[1, 2]"
/// Returns roll, pitch and yaw in degrees.
Vec3 rpyDegrees(const Mat3& R);
/// Returns "at [1, 2, 3], rpy_deg [0, 0, 90]", without the rotation if there is none.
std::string poseText(const RigidPose& pose);
nlohmann::ordered_json poseJson(const RigidPose& pose);  ///< position, quat_xyzw
/// Returns a path's length: "2 m, turning 3 rad" if the space has a planar or floating joint, else
/// "2 m, 3 rad". Leaves out metres or radians if no coordinate of the space has that unit. If the
/// space has more than one joint or body, the text ends with the result of summands(): "(sum over
/// the joints)", "(sum over the bodies)" or "(sum over joints and bodies)".
std::string lengthText(const ConfigurationSpace& space, double metres, double radians);
/// Returns "1e-12 m, 6e-12 rad": the largest half width of a tube in lengths and in angles. Leaves
/// out the unit that no coordinate of the space has.
std::string tubeText(const ConfigurationSpace& space, const Configuration& tube);
nlohmann::ordered_json tubeJson(const ConfigurationSpace& space, const Configuration& tube);
/// Returns a configuration as "x = 1, y = 2, yaw = 0.5".
std::string stateText(const ConfigurationSpace& space, const Configuration& q);
/// Returns a list of numbers. `q` may also be a Vec3, which is converted to a Configuration.
nlohmann::ordered_json numbersJson(const Configuration& q);
/// Returns null for an infinity and for NaN, which JSON cannot represent.
nlohmann::ordered_json numberJson(double value);

/// Returns a list of objects with the names `a` and `b` of the bodies and the `reason`.
nlohmann::ordered_json leftOutJson(const Model& model, const LeftOut& leftOut);

/// Returns the count with its digits in groups of three: "12,345".
std::string grouped(std::uint64_t count);
/// Returns the count with the noun, in the plural if the count is not 1: "1 edge", "2 edges".
std::string counted(std::uint64_t count, const std::string& noun);

}  // namespace corridor::app
