#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "collision/geometry/convex_part.h"
#include "collision/geometry/triangle_mesh.h"
#include "planner/robot/kinematic_tree.h"

namespace corridor {

/// The verifier proves or refutes a path of all robots of a problem. It is independent of the
/// planner's checker. The two share only the plain data of meshes, parts, frames and coordinates,
/// and no bound, pose, tree, distance or predicate.
///
/// The method is adaptive bisection (Schwarzer, Saha, Latombe 2005). At the middle of a time
/// interval of an edge, the distance d of two bodies is bounded from below. Take any point of one
/// body and any point of the other. Seen from the common ancestor of the two frames, their
/// displacements from the middle add up to at most the motion bound
///     bound = Σ |Δ_j|·h·reach_j  over the joints between the two frames.
/// Here h is the half width of the interval in t. reach_j is a constant: the length of the chain
/// after joint j, plus the radius of the body (1 for a prismatic joint).
///
/// 1. If d > bound + margin + tube + rounding, the interval is proved for this pair.
/// 2. Otherwise each near pair of leaf primitives is tested along directions of its own, such as
///    the one between its closest points. Three terms reduce the distance in such a direction: the
///    velocity at the middle; the tube, if it exceeds the tolerance; and a second-order term, which
///    is quadratic in h and the tube.
/// 3. Otherwise the interval is halved, until the motion bound is below the tolerance.
///
/// Distances come from plain AABB trees in long double, each certified by a slab between the two
/// triangles or parts. Contacts of triangles are decided in rational arithmetic.
///
/// Files: edge_curve (edges, forward kinematics, reach weights), triangle_gap and convex_gap
/// (distance of two leaf primitives), moved_slab (two moving leaf primitives), box_tree (two
/// bodies), exact_contact (rational arithmetic), winding (inside a solid), pair_prover (two bodies
/// in a time interval), verify_path (the bisection).

struct VerifyBody {
  std::string name;
  /// Either `mesh` is set, or there are parts. Not owned; must outlive the call. The vertices or
  /// points are in the frame's coordinates. Bodies may share a mesh: equal pointers share one tree.
  const TriangleMesh* mesh = nullptr;
  std::span<const ConvexPart> parts = {};
  bool solid = false;  ///< mesh only: its interior counts, too (a part is always solid)
  std::size_t frame = 0;
};

struct VerifyPair {
  std::size_t a = 0, b = 0;  ///< indices of bodies
};

struct PathProblem {
  const KinematicTree* tree = nullptr;        ///< not owned
  const ConfigurationSpace* space = nullptr;  ///< not owned; only its `coordinates()` are read
  std::vector<VerifyBody> bodies;
  std::vector<VerifyPair> pairs;
  double margin = 0;     ///< metres; a clearance of at most this is a violation
  Configuration tube;    ///< the proof holds for all curves in it (planner/model/task.h)
  double tolerance = 0;  ///< metres, > 0
  std::uint64_t workLimit = 2'000'000;  ///< distance queries; beyond it edges are left undecided
};

enum class PathVerdict {
  /// Every curve in the tube keeps more than the margin everywhere. This verdict is never wrong.
  proved,
  /// At least one finding is a refutation: a contact; a distance that margin or tube do not allow;
  /// an ambiguous half turn; a joint that would jump; or a state that is not valid data. A contact
  /// or distance is found at a pose that differs from the path's only by rounding: by at most 2^-48
  /// of the lengths involved, or by at most the tolerance.
  refuted,
  /// Neither. Somewhere the clearance beyond the margin is below twice the tolerance, or below the
  /// tube's displacement (MovedSlab has its first-order term, Reach its second-order term); or the
  /// rounding of a large value may exceed the clearance; or the work limit was reached.
  undecided
};

/// A fault of an edge: its first refutation, or else its first undecided place.
struct PathFinding {
  PathVerdict verdict = PathVerdict::undecided;
  int edge = 0;  ///< the edge from state `edge` to state `edge` + 1, from 0
  double t = 0;  ///< time on the edge, in [0, 1]
  /// The state at t. A contact is exact at a pose that differs from this state's by rounding only.
  Configuration configuration;
  std::string a, b;  ///< the two bodies that touch, or could not be decided there; empty: none
  std::uint32_t triangleA = 0, triangleB = 0;  ///< numbers in their meshes or parts
  Vec3 point = Vec3::Zero();  ///< the contact, or the closest point of `b`; metres, world
  double gap = 0;             ///< distance of the two bodies at t, metres; 0: contact
  std::string reason;         ///< a few words: "contact", "ambiguous half turn", …
};

struct PathReport {
  PathVerdict verdict = PathVerdict::proved;
  std::vector<PathFinding> findings;  ///< one per edge that is not proved, in order; the first 100
  int edges = 0;
  int edgesProved = 0;
  /// Metres. If the path is proved, every curve in the tube keeps at least this distance; infinite
  /// if no pair is tested. It is refined until one of three conditions holds: it reaches 90 % of
  /// the difference between `smallestDistanceMet` and the displacement by the tube; the motion
  /// bound of the worst interval is below the tolerance; or a limit of queries is reached. 0 if the
  /// path is not proved.
  double provenClearance = 0;
  /// Metres: the smallest distance met at the poses tested. The path's clearance is not larger.
  double smallestDistanceMet = std::numeric_limits<double>::infinity();
  std::uint64_t distanceQueries = 0;
};

/// Verifies a path through `states`. For a path of one state, this state is verified. The caller
/// must check the bounds of the variables, and that start and goal are those of the problem.
///
/// A state that is not finite, or has a zero quaternion, gives the finding `refuted`. If the
/// processor's floating-point mode makes the bounds invalid (collision/core/floating_point.h),
/// every edge is undecided.
/// @throws std::invalid_argument if there are no states; if a pointer is null; if margin, tube or
/// tolerance is negative or not finite, or the tolerance is 0; if the tube has another length than
/// a configuration; if a body has neither a mesh nor parts, or both, or an empty mesh or part; or
/// if a pair names a body that does not exist.
PathReport verifyPath(const PathProblem& problem, const std::vector<Configuration>& states);

}  // namespace corridor
