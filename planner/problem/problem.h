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
  /// "left" for `robots: {left: …}`. Empty for `robot: …`: names of its links, joints and
  /// coordinates then have no prefix.
  std::string name;
  std::filesystem::path file;  ///< robot.yaml; empty for a `.cfg`, a bare URDF or a benchmark set
  RobotModel model;
  RigidPose base;                       ///< X_WB
  std::vector<std::size_t> linkFrames;  ///< for each link of `model`, its frame in Problem::tree
};

/// A link or an obstacle: all shapes that are tested under one name.
struct ProblemBody {
  std::string name;       ///< "hand", "left/hand", "table"; for a rigid robot, the robot's name
  std::size_t frame = 0;  ///< in Problem::tree; 0 (the world) for an obstacle
  std::optional<std::size_t> robot;  ///< index in Problem::robots; empty for an obstacle
  std::vector<PlacedShape> shapes;   ///< at least one, in the coordinates of `frame`
};

/// A pair of bodies, and the reason if it is not tested.
struct ProblemPair {
  std::size_t a = 0, b = 0;  ///< bodies, a < b
  /// Empty if the pair is tested; otherwise the reason: "adjacent", "SRDF: Never", "allow", …
  std::string skipped;
};

/// A motion planning problem as read from a `problem.yaml`, an OMPL.app `.cfg` or a benchmark set
/// (`FILE.json#INDEX`). It is complete, and its input files are free of faults. Lengths are in
/// metres, angles in radians.
struct Problem {
  std::filesystem::path file;
  std::string name;
  /// The problem file and every other file that it is made of, each once, in the order in which
  /// they are first named.
  std::vector<std::filesystem::path> files;
  /// Decisions of the reader that a user may want to know: units, wrapped angles, held joints, …
  std::vector<std::string> notes;

  std::vector<ProblemRobot> robots;
  KinematicTree tree;
  /// The planned coordinates, by the names that `start` and `goal` use.
  ConfigurationSpace space;
  std::vector<ProblemBody> bodies;  ///< the robots' links that have shapes, then the world's
  /// Every pair of two different bodies of which at least one belongs to a robot.
  std::vector<ProblemPair> pairs;

  Configuration start;
  std::vector<Configuration> goals;  ///< one or more; a path may end at any of them
  /// The largest deviation of the path's end from one of `goals`, inclusive. Where a value is 0,
  /// only rounding is allowed.
  struct GoalRegion {
    double position = 0;  ///< |Δp| of each planar or floating joint, metres
    double angle = 0;     ///< rotation angle of each planar or floating joint, radians
    double joint = 0;     ///< each single joint, rad or m
  };
  std::optional<GoalRegion> goalRegion;
  std::optional<double> goalThreshold;  ///< `.cfg` only: in the distance of `space`

  /// Metres that the two bodies of every tested pair must keep apart; 0: touching is contact.
  double margin = 0;
  /// The half width of the tube that the proof covers, for each number of a configuration (m, rad).
  /// A rotation has its value at the first of its four numbers. Never less than 2^-40 of the
  /// coordinate's range, the allowance for rounding.
  Configuration tube;

  struct PlannerSpec {
    std::string name = "RRTConnect";
    double time = 20;  ///< seconds
    /// Whether to stop at the first solution. Unset: planners that optimise use all the time, and
    /// the others stop.
    std::optional<bool> stopAtFirst;
    std::map<std::string, std::string> params;  ///< by OMPL's own names
  } planner;
  /// The sampler of valid states: uniform, gaussian, obstacle_based, bridge_test or max_clearance.
  std::string sampler = "uniform";
  /// `.cfg` only: "length", "max_min_clearance" or "mechanical_work".
  std::optional<std::string> objective;
  double objectiveThreshold = 0;
  bool simplify = true;
  struct CheckerSpec {
    std::string edges = "certified";  ///< a name of `EdgeMethod`, or "discrete"
    double resolution = 0.01;         ///< for discrete: OMPL's longest_valid_segment_fraction
    std::optional<double> tolerance;  ///< metres; unset: see checker/default_tolerance.h
    std::string volume = "obb";       ///< the trees' bounding volume: a name in `volumeKinds()`
    std::string fit, overlap;         ///< names in that VolumeKind; empty: its first

    TreeNames trees() const { return {volume, fit, overlap}; }
  } checker;
  std::uint64_t seed = 1;

  /// The line (from 1) of each key in the problem file, such as "planner.params.range", for faults
  /// that are found after reading. A `.cfg` uses the YAML key with the same meaning where there is
  /// one ("start", "planner.name", "planner.params.range", "sampler", …).
  std::map<std::string, int> lines;
  /// Returns a fault at the line of `key`. Without such a line it takes the nearest enclosing key
  /// ("planner.params", then "planner"), and without any of these no line (0).
  Fault faultAt(std::string_view key, std::string text) const;
};

/// Returns the first word of `volume`, `fit` and `overlap` that is unknown or does not belong to
/// the volume, or nullopt. The methods `adaptive` and `advancement` measure distances, so for them
/// an overlap test other than the volume's first is wrong, too. `edges` itself is not checked.
std::optional<InvalidName> invalidNameIn(const Problem::CheckerSpec& checker);

/// Reads a `problem.yaml`, a folder that holds one, an OMPL.app `.cfg`, or one problem of a
/// MotionBenchMaker set, `FILE.json#INDEX`.
/// @throws InputError with all faults of the file and of the files that it names.
Problem readProblem(const std::filesystem::path& path);

}  // namespace corridor
