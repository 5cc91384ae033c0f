#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "collision/core/error.h"
#include "planner/model/model.h"
#include "planner/model/settings.h"
#include "planner/model/task.h"
#include "planner/robot/note.h"

namespace corridor {

/// The files that a problem was read from, and notes that were made while reading. Messages and
/// solution files use them.
struct Source {
  std::filesystem::path file;
  std::string name;
  /// The problem file and all files that it names, directly or through other files. Each file is
  /// listed once, where it first occurs in the order that README.md gives (section The digest).
  std::vector<std::filesystem::path> files;
  /// Decisions of the reader that a user may want to know: units, wrapped angles, held joints, …
  std::vector<Note> notes;
  /// The line (from 1) of each key in the problem file, such as "planner.params.range", for faults
  /// that are found after reading. For a `.cfg`, the key is the YAML key with the same meaning, if
  /// there is one ("start", "planner.name", "planner.params.range", "sampler", …).
  std::map<std::string, int> lines;

  /// Returns a fault at the line of `key`. If `key` has no line, the fault is at the line of the
  /// nearest enclosing key ("planner.params", then "planner"). If none of these has a line, the
  /// line is 0 (none).
  Fault faultAt(std::string_view key, std::string text) const;
};

/// A motion planning problem as read from a `problem.yaml`, an OMPL.app `.cfg` or a benchmark set
/// (`FILE.json#INDEX`). All members are set, and the input files had no faults. Lengths are in
/// metres, angles in radians.
struct Problem {
  Model model;
  Task task;
  Settings settings;
  Source source;
};

/// Reads a `problem.yaml`, a folder that holds one, an OMPL.app `.cfg`, or one problem of a
/// MotionBenchMaker set, `FILE.json#INDEX`.
/// @throws InputError with all faults of the file and of the files that it names. If there are
/// notes on what could be read, the error is a NotedInputError, which contains these notes.
/// @param cache where meshes are looked for before they are read, and later, by checkers of the
/// model, their trees and hulls; null: none. The problem is the same with and without a cache.
Problem readProblem(const std::filesystem::path& path, std::shared_ptr<FileCache> cache = nullptr);

/// Replaces the margin of a problem. If the proof that some pairs of links are never in contact
/// does not cover the new margin plus the padding, these pairs are tested, and a note reports it.
/// @pre `margin` is in metres, finite, and 0 or more.
void setMargin(Problem& problem, double margin);
/// Replaces the tube of a problem. Pairs that were proved never in contact only for less than the
/// new tube are tested, and a note says so. @pre `tube` has half widths as `tubeOf` returns them.
void setTube(Problem& problem, Configuration tube);

}  // namespace corridor
