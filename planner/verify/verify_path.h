#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "collision/geometry/convex_part.h"
#include "collision/geometry/triangle_mesh.h"
#include "planner/robot/kinematic_tree.h"

namespace corridor {

/// The second opinion: proves or refutes the path of everything that moves by other means than
/// those which found it.
///
/// It shares the plain data of meshes, parts, frames and coordinates with the rest of Corridor, and
/// nothing else: no bound, no pose, no tree, no distance, no predicate. What it does is as plain as
/// can be: adaptive bisection (Schwarzer, Saha, Latombe 2005). At the middle of an interval of an
/// edge the distance d of two bodies is bounded from below; seen from their frames' common
/// ancestor, no point goes further than
///     travel = Σ over the joints between the two of |Δ_j|·h·reach_j
/// from there during the interval (h half of it in t, reach_j a constant: the length of the chain
/// after the joint). If d > travel + margin + tube + rounding, then the interval is proved for this
/// pair. Else every pair of triangles that comes near is given a slab of its own, along which only
/// the velocity at the middle counts, and what the tube does (where it is more than the tolerance),
/// and a constant times (h + tube)²; where that fails, the interval is halved, until the travel is
/// under the tolerance. Distances come from plain AABB trees in long double, each certified by a
/// slab between the two triangles (or parts); contacts of triangles are decided in rational
/// arithmetic.
///
/// Folder: edge_curve (what an edge is, forward kinematics, reach weights), triangle_gap and
/// convex_gap (two pieces), moved_slab (two that move), box_tree (two bodies), exact_contact
/// (rationals), winding (inside a solid), verify_path (the bisection).

struct VerifyBody {
  std::string name;
  /// Exactly one of the two, not owned; must outlive the call. In the frame's coordinates.
  const TriangleMesh* mesh = nullptr;
  const ConvexPart* part = nullptr;
  bool solid = false;  ///< of a mesh: what it encloses counts, too (parts are always solid)
  std::size_t frame = 0;
};

struct VerifyPair {
  std::size_t a = 0, b = 0;  ///< bodies, by index
};

struct PathProblem {
  const KinematicTree* tree = nullptr;        ///< plain data; not owned
  const ConfigurationSpace* space = nullptr;  ///< for its `coordinates()`; not owned
  std::vector<VerifyBody> bodies;
  std::vector<VerifyPair> pairs;
  double margin =
      0;  ///< metres; a clearance of at most this is a violation (0: touching is contact)
  Configuration tube;                   ///< the proof holds for all curves in it (Problem::tube)
  double tolerance = 0;                 ///< metres, > 0
  std::uint64_t workLimit = 2'000'000;  ///< distance queries; beyond it edges are left undecided
};

enum class PathVerdict {
  proved,   ///< every curve in the tube keeps more than the margin, everywhere; never wrong
  refuted,  ///< some finding is: a contact, or a point closer than margin or tube allow, at a
            ///< pose within rounding of the path (2^-48 of the lengths involved, or the tolerance);
            ///< an ambiguous half turn; a joint that would jump; or a state that is no state
  undecided  ///< neither: the clearance left is somewhere less than twice the tolerance, or than
             ///< what the tube takes of it by MovedSlab's first order and Reach's second; or the
             ///< rounding of a large value takes it; or the work limit was reached
};

/// What is wrong with an edge.
struct PathFinding {
  PathVerdict verdict = PathVerdict::undecided;
  int edge = 0;                 ///< from state `edge` to state `edge` + 1, from 0
  double t = 0;                 ///< in [0, 1] of the edge
  Configuration configuration;  ///< at t; contacts are exact at poses within rounding of it
  std::string a, b;  ///< names of the two bodies that meet, or are closest there; empty: none
  std::uint32_t triangleA = 0, triangleB = 0;  ///< in their meshes; 0 for parts
  Vec3 point = Vec3::Zero();  ///< where they meet, or the closest point of `b`; metres, world
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

/// A path of one state is a check of that state. Bounds of the variables, and whether start and
/// goal are those of the problem, are the caller's to check.
/// @throws std::invalid_argument for no states, for null pointers, and for a margin, tube or
/// tolerance that is negative or not finite. A state that is not finite or has a zero quaternion is
/// a finding. Where the processor is set so that no bound holds (collision/core/floating_point.h)
/// every edge is undecided.
PathReport verifyPath(const PathProblem& problem, const std::vector<Configuration>& states);

}  // namespace corridor
