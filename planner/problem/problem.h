#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "collision/core/error.h"
#include "collision/geometry/mesh_file.h"
#include "collision/hierarchy/tree_kinds.h"
#include "planner/robot/kinematic_tree.h"
#include "planner/robot/robot_model.h"

namespace corridor {

/// A robot of a problem.
struct ProblemRobot {
  std::string name;  ///< "left" of `robots: {left: …}`; "" of `robot:`, whose parts have no prefix
  std::filesystem::path file;  ///< robot.yaml; empty: `.cfg`, or a bare URDF or benchmark set
  RobotModel model;
  RigidPose base;                       ///< X_WB
  std::vector<std::size_t> linkFrames;  ///< of each link of the model: its frame in the tree
};

/// Something that is tested against others under one name: a link (all its shapes), or an obstacle.
struct ProblemBody {
  std::string name;       ///< "hand", "left/hand", "table"; a rigid robot's: its own name
  std::size_t frame = 0;  ///< 0: an obstacle
  std::optional<std::size_t> robot;  ///< index; none: an obstacle
  std::vector<PlacedShape> shapes;   ///< at least one, in the frame's coordinates
};

/// A pair of bodies, and why it isn't tested.
struct ProblemPair {
  std::size_t a = 0, b = 0;  ///< bodies, a < b
  std::string skipped;  ///< "": tested; else the reason: "adjacent", "SRDF: Never", "allow", …
};

/// A motion planning problem, checked and complete: what `problem.yaml`, an OMPL.app `.cfg` or a
/// problem of a benchmark set (`FILE.json#INDEX`) says. Lengths in metres, angles in radians.
struct Problem {
  std::filesystem::path file;
  std::string name;
  /// SHA-256 in hex of the SHA-256 digests (32 bytes each, one after the other) of the problem
  /// file and of every other file it is made of, in the order in which they are first named:
  /// `digestOfFiles`.
  std::string digest;
  std::vector<std::filesystem::path> files;  ///< those
  std::vector<std::string>
      notes;  ///< what the reader decided and a user may want to know (units, wrapping, …)

  std::vector<ProblemRobot> robots;
  KinematicTree tree;
  /// What is planned for. Coordinates have the names that start and goal use.
  ConfigurationSpace space;
  std::vector<ProblemBody> bodies;  ///< the robots' links that have shapes, then the world's
  /// Every pair that could be tested (not: obstacle with obstacle, a body with itself).
  std::vector<ProblemPair> pairs;

  Configuration start;
  std::vector<Configuration> goals;  ///< one or more: any of them will do
  /// How far from one of `goals` the end may be; 0: nothing but rounding.
  struct GoalRegion {
    double position = 0;  ///< |Δp| of planar and floating joints, metres
    double angle = 0;     ///< and their rotation, radians
    double joint = 0;     ///< each single joint, rad or m
  };
  std::optional<GoalRegion> goalRegion;
  std::optional<double> goalThreshold;  ///< .cfg only: in the space's distance

  double margin = 0;
  /// For each number of a configuration how far it may stray and still be covered by the proof
  /// (m, rad; of a rotation: the first of its four). Never less than rounding, 2^-40 of the
  /// coordinate's range.
  Configuration tube;

  struct PlannerSpec {
    std::string name = "RRTConnect";
    double time = 20;  ///< seconds
    std::optional<bool>
        stopAtFirst;  ///< unset: first for planners that find, time for those that optimise
    std::map<std::string, std::string> params;  ///< OMPL's own names
  } planner;
  std::string sampler =
      "uniform";  ///< uniform, gaussian, obstacle_based, bridge_test, max_clearance
  std::optional<std::string>
      objective;  ///< .cfg only: "length", "max_min_clearance", "mechanical_work"
  double objectiveThreshold = 0;
  bool simplify = true;
  struct CheckerSpec {
    std::string edges = "certified";  ///< a name of `EdgeMethod`, or "discrete"
    double resolution = 0.01;         ///< discrete: OMPL's longest_valid_segment_fraction
    std::optional<double> tolerance;  ///< metres; unset: see checker/default_tolerance.h
    std::string volume = "obb";       ///< of the trees: a name of `volumeKinds`
    std::string fit, overlap;         ///< of the volume's own; empty: its first

    TreeWords trees() const { return {volume, fit, overlap}; }
  } checker;
  std::uint64_t seed = 1;

  /// Where the problem file says what, for faults that are found later: "planner.params.range" →
  /// line, from 1. `.cfg`: the same keys where there is one that means the same ("start",
  /// "planner.name", "planner.params.range", "sampler", …).
  std::map<std::string, int> lines;
  /// A fault of this problem at that key, or at the nearest one around it ("planner.params",
  /// "planner"), or at no line.
  Fault faultAt(std::string_view key, std::string text) const;
};

/// What in it is unknown or doesn't go together: of the volume, its fits and its overlap tests; and
/// of the latter what edges have no use for. (Its edges aren't looked at otherwise.)
std::optional<WrongWord> wrongWordIn(const Problem::CheckerSpec& checker);

/// Reads a problem: a `problem.yaml`, a folder that holds one, an OMPL.app `.cfg`, or one problem
/// of a MotionBenchMaker set as `FILE.json#INDEX`.
/// @throws InputError with all faults of the file at once.
Problem readProblem(const std::filesystem::path& path);

/// Problem::digest of these files. In a shell: sha256sum FILES | cut -c-64 | xxd -r -p | sha256sum.
/// @throws InputError if one can't be read.
std::string digestOfFiles(const std::vector<std::filesystem::path>& files);

}  // namespace corridor
