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
#include "collision/motion/rigid_motion.h"

namespace corridor {

enum class RigidSpace { SE2, SE3 };

/// A mesh of a problem as it is used: scale, up-axis turn, local pose and (for a robot) the shift
/// to the reference point are already in the vertices.
struct ProblemMesh {
  std::string name;  ///< "table"; a robot's shapes: "piano", or "piano/lid" where there are several
  std::filesystem::path file;
  MeshFile source;  ///< format and rules; `mesh` is the final one
};

/// A rigid-body planning problem, checked and complete: what `problem.yaml` or an OMPL.app `.cfg`
/// says. Lengths in metres, angles in radians.
struct Problem {
  std::filesystem::path file;
  std::string name;
  /// SHA-256 in hex of the SHA-256 digests (32 bytes each, one after the other) of the problem
  /// file, the robot file (.cfg: none), the robot's mesh files and the world's, in that order:
  /// `digestOfFiles`.
  std::string digest;
  RigidSpace space = RigidSpace::SE3;

  std::vector<ProblemMesh> robot;
  std::vector<ProblemMesh> world;
  std::vector<std::string>
      notes;  ///< what the reader decided and a user may want to know (units, recentring, …)

  RigidPose start, goal;             ///< quaternions as given; SE2: see startYaw
  double startYaw = 0, goalYaw = 0;  ///< SE2 only
  struct GoalRegion {
    double position = 0, angle = 0;
  };  ///< metres, radians of rotation; 0: the goal state itself
  std::optional<GoalRegion> goalRegion;
  std::optional<double> goalThreshold;  ///< .cfg only: in the state space's distance

  Vec3 lower = Vec3::Zero(), upper = Vec3::Zero();  ///< bounds of the reference point; SE2: x and y
  /// Metres per radian in the state space's distance. SE3: of the quaternion angle, which is half
  /// the rotation's angle (OMPL's default 1); SE2: of the yaw (OMPL's default 0.5). A robot file's
  /// weights.rotation is per radian of rotation in both.
  double rotationWeight = 1;

  double margin = 0;
  /// Unset: rounding only, 2^-40 of each coordinate's range; so is a component that is 0.
  std::optional<Tube> tube;

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
    std::string edges = "certified";  ///< or "discrete"
    double resolution = 0.01;         ///< discrete: OMPL's longest_valid_segment_fraction
    std::optional<double> tolerance;  ///< metres; unset: 1e-7 of the smaller side's bounding radius
    std::string fit = "triangles";    ///< of the OBBs: vertices, triangles, hull
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

/// Reads a problem: a `problem.yaml`, a folder that holds one, or an OMPL.app `.cfg`.
/// @throws InputError with all faults of the file at once.
Problem readProblem(const std::filesystem::path& path);

/// Problem::digest of these files. In a shell: sha256sum FILES | cut -c-64 | xxd -r -p | sha256sum.
/// @throws InputError if one can't be read.
std::string digestOfFiles(const std::vector<std::filesystem::path>& files);

}  // namespace corridor
