#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "planner/problem/text_words.h"

/// The parts of `corridor new`, one per kind of file, and what they share.
namespace corridor::app {

/// Where a new file is written.
struct NewFileArguments {
  std::optional<std::string> output;  ///< unset, or "-": the standard output
  bool force = false;                 ///< an existing file may be replaced

  bool toStdout() const { return !output || *output == "-"; }
};

struct NewRobotArguments {
  std::string urdf;
  std::optional<std::string> srdf;
  std::vector<std::string> packages;  ///< NAME=FOLDER
  std::vector<std::string> joints;    ///< the joints that are planned for; empty: see the file
  /// Whether pairs in contact in nearly all random states are allowed, not left to decide.
  bool allowOverlaps = false;
  std::optional<std::string> visuals, limits, colladaUp;
  double margin = 0.01;        ///< metres that a pair must keep to count as never in contact
  double beyondLimits = 0.01;  ///< how far beyond a joint limit a proof also holds, rad or m
  /// Work limit for the proofs of all pairs together, in the unit of `PairSurveyOptions::work`.
  std::uint64_t work = 250'000;
  std::uint64_t samples = 1000;
  std::uint64_t seed = 1;
  NewFileArguments file;
};

struct NewProblemArguments {
  std::string robot;
  std::uint64_t seed = 1;
  NewFileArguments file;
};

int newRobot(const NewRobotArguments& arguments);
int newProblem(const NewProblemArguments& arguments);

/// Tests that the new file can be written, and that it would not replace an existing file unless
/// `force` is set. Commands call this before they spend time on the file's contents.
/// @throws InputError that names the option.
void requireNewFile(const NewFileArguments& file);
/// Writes the text to the standard output, or to the file. The file is written whole or not at all.
void writeNewFile(const NewFileArguments& file, const std::string& text);

/// Returns a path in the form in which the new file has to name it: relative to the new file's
/// folder. If the new file is written to the standard output, the path is relative to the current
/// folder.
std::string pathFrom(const NewFileArguments& file, const std::filesystem::path& path);

/// Returns the words as a YAML list: "[a, b]".
std::string yamlList(const std::vector<std::string>& words);
/// Returns the text as a comment: each line has `indent` blanks, "# ", and at most 100 characters
/// if its words allow it. Further lines of an item ("- …") or a key ("joints: …") are indented by
/// two more blanks.
std::string comment(const std::string& text, int indent = 0);

}  // namespace corridor::app
