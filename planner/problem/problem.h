#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "collision/core/error.h"
#include "planner/model/model.h"
#include "planner/model/settings.h"
#include "planner/model/task.h"

namespace corridor {

/// Where a problem comes from, for messages and solution files.
struct Source {
  std::filesystem::path file;
  std::string name;
  /// The problem file and every other file that it is made of, each once, in the order in which
  /// they are first named.
  std::vector<std::filesystem::path> files;
  /// Decisions of the reader that a user may want to know: units, wrapped angles, held joints, …
  std::vector<std::string> notes;
  /// The line (from 1) of each key in the problem file, such as "planner.params.range", for faults
  /// that are found after reading. A `.cfg` uses the YAML key with the same meaning where there is
  /// one ("start", "planner.name", "planner.params.range", "sampler", …).
  std::map<std::string, int> lines;

  /// Returns a fault at the line of `key`. Without such a line it takes the nearest enclosing key
  /// ("planner.params", then "planner"), and without any of these no line (0).
  Fault faultAt(std::string_view key, std::string text) const;
};

/// A motion planning problem as read from a `problem.yaml`, an OMPL.app `.cfg` or a benchmark set
/// (`FILE.json#INDEX`). It is complete, and its input files are free of faults. Lengths are in
/// metres, angles in radians.
struct Problem {
  Model model;
  Task task;
  Settings settings;
  Source source;
};

/// Reads a `problem.yaml`, a folder that holds one, an OMPL.app `.cfg`, or one problem of a
/// MotionBenchMaker set, `FILE.json#INDEX`.
/// @throws InputError with all faults of the file and of the files that it names.
Problem readProblem(const std::filesystem::path& path);

}  // namespace corridor
