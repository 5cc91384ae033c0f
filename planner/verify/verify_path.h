#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "collision/geometry/triangle_mesh.h"
#include "collision/motion/rigid_motion.h"

namespace corridor {

/// The second opinion: proves or refutes the path of a rigid body by other means than those which
/// found it.
///
/// It shares the types of meshes and poses with the rest of Corridor, and nothing else: no bound,
/// no pose, no tree, no distance, no predicate. What it does is as plain as can be: adaptive
/// bisection (Schwarzer, Saha, Latombe 2005). At the middle of an interval of an edge the distance
/// d of the meshes is bounded from below; no point of the body goes further than
///     travel = |Δp|·h + |angle|·h·reach
/// from there during the interval (h half of it in t, reach the largest distance of a vertex from
/// the reference point). If d > travel + margin + tube + rounding, then the interval is proved,
/// else it is halved, until the travel is under the tolerance. Distances come from plain AABB trees
/// in long double, each certified by a slab between the two triangles; contacts are decided in
/// rational arithmetic.
///
/// Folder: edge_curve (what an edge is), triangle_gap (two triangles), box_tree (two soups),
/// exact_contact (rationals), verify_path (the bisection).

struct VerifyBody {
  std::string name;
  const TriangleMesh* mesh = nullptr;  ///< not owned; must outlive the call
};

struct PathProblem {
  std::vector<VerifyBody> moving;  ///< in the frame of the body: its reference point is the origin
  std::vector<VerifyBody> fixed;   ///< in the frame of the world
  double margin =
      0;      ///< metres; a clearance of at most this is a violation (0: touching is contact)
  Tube tube;  ///< the proof holds for all curves in it
  double tolerance = 0;  ///< metres; 0: 1e-7 of the smaller of the two sides' bounding radii
  std::uint64_t workLimit = 2'000'000;  ///< distance queries; beyond it edges are left undecided
};

enum class PathVerdict {
  proved,    ///< every curve in the tube keeps more than the margin, everywhere; never wrong
  refuted,   ///< some finding is: a contact at a pose within rounding of the path (relative 2^-50),
             ///< a point closer than margin or tube allow, an ambiguous half turn, or a state that
             ///< is no state
  undecided  ///< neither: the clearance left is somewhere less than twice the tolerance, or the
             ///< work limit was reached
};

/// What is wrong with an edge.
struct PathFinding {
  PathVerdict verdict = PathVerdict::undecided;
  int edge = 0;    ///< from state `edge` to state `edge` + 1, from 0
  double t = 0;    ///< in [0, 1] of the edge
  RigidPose pose;  ///< of the body at t; contacts are exact at these doubles
  double yaw = 0;  ///< SE(2): of `pose`
  std::string moving,
      fixed;  ///< names of the two bodies that meet, or are closest there; empty: none
  std::uint32_t movingTriangle = 0, fixedTriangle = 0;  ///< in their meshes
  Vec3 point = Vec3::Zero();  ///< where they meet, or the closest point of `fixed`; metres, world
  double gap = 0;             ///< distance of the two at t, metres; 0: contact
  std::string reason;         ///< a few words: "contact", "ambiguous half turn", …
};

struct PathReport {
  PathVerdict verdict = PathVerdict::proved;
  std::vector<PathFinding> findings;  ///< one an edge that isn't proved, in order; the first 100
  int edges = 0;
  int edgesProved = 0;
  /// Metres. Where proved: every curve in the tube keeps at least this distance (infinite where one
  /// side is empty). It is refined to 90 % of what is left of `smallestDistanceMet` under the tube,
  /// or to the tolerance; else 0.
  double provenClearance = 0;
  /// Metres: the least distance met at the poses looked at. The clearance of the path is no larger.
  double smallestDistanceMet = std::numeric_limits<double>::infinity();
  std::uint64_t distanceQueries = 0;
};

/// Meshes are taken for their surfaces. A path of one state is a check of that state. Bounds of the
/// reference point, and whether start and goal are those of the problem, are the caller's to check.
/// @throws std::invalid_argument for no states, for a null mesh, and for a margin, tube or
/// tolerance that is negative or not finite. A state that is not finite or has a zero quaternion is
/// a finding.
PathReport verifyPath(const PathProblem& problem, const std::vector<RigidPose>& states);

/// The same in the plane, states (x, y, yaw): metres and radians. z is 0.
PathReport verifyPath(const PathProblem& problem, const std::vector<Eigen::Vector3d>& states);

}  // namespace corridor
