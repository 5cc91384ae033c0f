#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "collision/geometry/convex_part.h"
#include "collision/geometry/triangle_mesh.h"
#include "planner/robot/curve.h"
#include "planner/robot/kinematic_tree.h"

namespace corridor {

/// The verifier proves or refutes a path of all robots of a problem. It is independent of the
/// planner's checker: the verifier and the checker share only the plain data of meshes, parts,
/// frames and coordinates. They share no bound, pose, tree, distance or predicate.
///
/// The method is adaptive bisection (Schwarzer, Saha, Latombe 2005). At the middle of a time
/// interval of an edge, the distance d of two bodies is bounded from below. Take any point of one
/// body and any point of the other. Seen from the common ancestor of the two frames, their
/// displacements from the middle add up to at most the motion bound
///     bound = Σ |Δ_j|·h·reach_j  over the joints between the two frames.
/// Here h is the half width of the interval in t, and Δ_j is the displacement of joint j along the
/// whole edge. The constant reach_j is the length of the chain after joint j, plus the radius of
/// the body. For a prismatic joint, reach_j is 1.
///
/// 1. If d > bound + margin + tube + rounding, the interval is proved for this pair.
/// 2. Otherwise each near pair of leaf primitives is tested along directions of its own, such as
///    the direction between its closest points. Three terms reduce the distance in a direction: the
///    velocity at the middle; the tube, if it exceeds the tolerance; and a second-order term, which
///    is quadratic in h and the tube.
/// 3. Otherwise the interval is halved, until the motion bound is below the tolerance.
///
/// Distances come from plain AABB trees in long double, each certified by a slab between the two
/// triangles or parts. Contacts of triangles are decided in rational arithmetic.
///
/// verifyCurve() uses this method for polynomial pieces instead of edges. A piece is cut into
/// eighths. The largest |q_j'| in the eighth that contains the interval then replaces |Δ_j|. (For
/// an interval longer than an eighth: the largest |q_j'| in the interval itself.) The second-order
/// term also has the largest |q_j''| there (edge_curve.h).
///
/// Files: edge_curve (edges and pieces, forward kinematics, reach weights), bernstein
/// (polynomials), curve_joins (the ends of pieces), polynomial_range (limits), proved_range (where
/// the pairs are all that matters), triangle_gap and
/// convex_gap (distance of two leaf primitives), moved_slab (two moving leaf primitives), body_tree
/// (two bodies), exact_contact (rational arithmetic), winding (inside a solid), pair_prover (two
/// bodies in a time interval), verify_path (the bisection).

struct VerifyBody {
  std::string name;
  /// A body has either a `mesh` or `parts`. Neither is owned; both must outlive the call. The
  /// vertices or points are in the frame's coordinates. Bodies with the same `mesh` pointer share
  /// one tree.
  const TriangleMesh* mesh = nullptr;
  std::span<const ConvexPart> parts = {};
  bool solid = false;  ///< mesh only: its interior counts, too (a part is always solid)
  std::size_t frame = 0;
};

struct VerifyPair {
  std::size_t a = 0, b = 0;  ///< indices of bodies
  double padding = 0;        ///< metres that the pair keeps in addition to the margin
};

struct PathProblem {
  const KinematicTree* tree = nullptr;        ///< not owned
  const ConfigurationSpace* space = nullptr;  ///< not owned; only its `coordinates()` are read
  std::vector<VerifyBody> bodies;
  std::vector<VerifyPair> pairs;
  /// Pairs of bodies that never move relative to each other: no joint that moves is between their
  /// frames. They are tested once, at the first state, and this decides them for every state.
  /// `provedClearance` and `closestFound` are about `pairs` only.
  std::vector<VerifyPair> heldPairs;
  /// The values of each number of a configuration, inclusive, for which bodies that are in no pair
  /// are proved apart by other means (planner/model/pair_proofs.h); infinite where it does not
  /// matter. An edge or piece that leaves these values is not proved: it is undecided if it is not
  /// refuted. Empty: no limit.
  Configuration provedLower, provedUpper;
  double margin = 0;  ///< metres; a clearance of at most margin + padding is a violation
  /// Metres. `PathReport::provedClearance` is refined until it reaches this value, or nearly the
  /// largest value that the path may have. It does not change the verdict.
  double wantedClearance = 0;
  Configuration tube;    ///< the proof holds for all curves in the tube (planner/model/task.h)
  double tolerance = 0;  ///< metres, > 0
  /// The maximum number of distance queries. When it is reached, all edges that are not decided yet
  /// become undecided, with the reason kWorkLimit.
  std::uint64_t workLimit = 2'000'000;
};

enum class PathVerdict {
  /// Every curve in the tube keeps more than margin and padding everywhere. This verdict is never
  /// wrong.
  proved,
  /// At least one finding is a refutation: a contact; a distance that the margin, the padding or
  /// the tube does not allow; an ambiguous half turn; a joint that would jump; or a state that is
  /// not valid data. The pose at which a contact or distance was found differs from the path's pose
  /// only by rounding: by at most 2^-48 of the lengths involved, or by at most the tolerance.
  refuted,
  /// The path is neither proved nor refuted, for one of these reasons:
  /// - Somewhere the clearance beyond the margin is below twice the tolerance.
  /// - Somewhere the clearance beyond the margin is below the displacement by the tube. MovedSlab
  ///   computes the first-order term of this displacement, and Reach the second-order term.
  /// - The rounding of a large value may exceed the clearance, or the processor's floating-point
  ///   mode makes the bounds invalid.
  /// - The work limit was reached.
  /// - An edge or piece leaves PathProblem::provedLower and provedUpper.
  undecided
};

/// The PathFinding::reason of edges that are undecided because the work limit was reached.
inline constexpr const char* kWorkLimit = "work limit reached";

/// A fault of an edge: a refutation, or else an undecided time. On the first refuted edge of a
/// path, it is the first refutation along the edge (`freeUntil`). On other edges, it is the
/// refutation that the verifier met first, or else the first undecided time that it met.
struct PathFinding {
  PathVerdict verdict = PathVerdict::undecided;
  int edge = 0;  ///< the edge from state `edge` to state `edge` + 1, from 0; or the piece
  double t = 0;  ///< time on the edge, in [0, 1]
  /// True for a pair of `heldPairs`: the fault is the same in every state of the path. `edge` and
  /// `t` are then 0, and `freeUntil` is not set.
  bool inEveryState = false;
  /// On the first refuted edge, the edge is proved on [0, freeUntil] unless this is 0, and its
  /// first refutation is in [freeUntil, t]. This bracket is narrowed until the motion bound in it
  /// is below the tolerance, its width is below 2^-30, or a limit of queries is reached. The value
  /// is set only on the first refuted edge, and only for a fault of two bodies. On other edges, `t`
  /// need not be the time of the first refutation.
  std::optional<double> freeUntil;
  /// The state at t. A contact is exact at a pose that differs from this state's by rounding only.
  Configuration configuration;
  /// The two bodies that touch or are too close at t, or that could not be decided there. Both
  /// names are empty if the fault does not concern two bodies.
  std::string a, b;
  /// Indices of the triangles in the meshes, or of the convex parts in the bodies.
  std::uint32_t primitiveA = 0, primitiveB = 0;
  /// A point of contact, a point of one body inside the other, or the closest point of `b`; metres,
  /// in the world frame.
  Vec3 point = Vec3::Zero();
  double gap = 0;       ///< distance of the two bodies at t, metres; 0: contact, or inside
  double required = 0;  ///< distance that two bodies must keep: margin plus padding, metres
  std::string reason;   ///< a few words: "contact", "ambiguous half turn", …
};

struct PathReport {
  PathVerdict verdict = PathVerdict::proved;
  /// First the findings of `heldPairs`, one for each two names of bodies that are not proved; then
  /// one for each edge that is not proved, in the order of the edges; at most 100 in all. The first
  /// refutation among the findings about edges is the first refutation by `pairs` (see
  /// PathFinding::freeUntil).
  std::vector<PathFinding> findings;
  int edges = 0;
  int edgesProved = 0;  ///< 0 if a pair of `heldPairs` is not proved
  /// Metres. If the path is proved, the bodies of `pairs` keep at least this distance on every
  /// curve in the tube. If the path is not proved, the value is 0. If no pair is tested, it is
  /// infinite. The value is refined until one of three conditions holds:
  /// - It reaches 90 % of the difference between `closestFound` and the displacement by the
  ///   tube; and also `PathProblem::wantedClearance`, or 99 % of the difference if that is smaller.
  /// - The motion bound of the worst interval is below the tolerance.
  /// - A limit of queries is reached.
  double provedClearance = 0;
  /// Metres: the smallest distance found at the tested poses. The path's clearance is at most this.
  double closestFound = std::numeric_limits<double>::infinity();
  std::uint64_t distanceQueries = 0;
};

/// Verifies a path through `states`. If there is only one state, it is verified alone. The caller
/// must check that all states are within their bounds, and that the first and the last state are
/// the problem's start and goal.
///
/// A state that is not finite, or has a zero quaternion, gives the finding `refuted`. If the
/// processor's floating-point mode makes the bounds invalid (collision/core/floating_point.h),
/// every edge is undecided.
/// @throws std::invalid_argument in these cases:
/// - `states` is empty, or a pointer is null.
/// - Margin, padding, wanted clearance, tube or tolerance is negative or not finite, or the
/// tolerance is 0.
/// - The tube has another length than a configuration; or provedLower or provedUpper has, and they
/// are not both empty.
/// - A body has neither a mesh nor parts, or both, or an empty mesh or part. Or a vertex, a point
/// or
///   a radius is not finite.
/// - A frame of the tree has a number that is not finite, or a zero quaternion.
/// - A pair names a body that does not exist, or a pair of `heldPairs` has a joint that moves
/// between its bodies.
PathReport verifyPath(const PathProblem& problem, const std::vector<Configuration>& states);

/// Verifies a curve of polynomial pieces, one after the other, as verifyPath() verifies edges. In
/// the report, an edge is a piece: PathFinding::edge is its index, and PathFinding::t is the
/// parameter τ of CurvePiece. The caller computes times from its knots, and checks the limits of
/// positions, velocities and accelerations (polynomial_range.h).
///
/// The proof holds for every curve that differs from a piece by at most the tube plus the piece's
/// `error`. A contact of the polynomial refutes the curve only if `error` displaces no body by more
/// than the tolerance. Otherwise a piece with such a contact is undecided.
///
/// These faults give the finding `refuted`:
/// - "jump": the piece does not begin where the piece before it ends. The ends may differ by the
///   sum of the errors of both pieces. A circle must not jump by whole turns, either.
/// - "ambiguous half turn": a rotation turns by 180° within 1e-9 rad in one piece.
/// - "not a valid state": a coefficient is not finite, or a rotation begins or ends with a zero
///   quaternion.
/// @throws std::invalid_argument as verifyPath() does; also if `pieces` is empty, or if a piece has
/// the wrong number of rows, a degree outside of [1, CurvePiece::kLargestDegree], or an error that
/// is negative, not finite, or of another length than a configuration.
PathReport verifyCurve(const PathProblem& problem, std::span<const CurvePiece> pieces);

}  // namespace corridor
