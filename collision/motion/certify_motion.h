#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "collision/core/query_context.h"
#include "collision/hierarchy/body.h"
#include "collision/hierarchy/tree_kinds.h"
#include "collision/motion/motion_window.h"

namespace corridor {

/// Two bodies that touch, by their indices in the scene, and where: triangles by their numbers in
/// their meshes; 0 for a primitive.
struct Contact {
  std::size_t bodyA = 0, bodyB = 0;
  std::uint32_t triangleA = 0, triangleB = 0;
};

enum class MotionVerdict { free, contact, undecided };
enum class UndecidedReason {
  none,
  clearance,      ///< the clearance is under twice the tolerance somewhere
  workLimit,      ///< the query's work limit was reached
  ambiguous,      ///< a half turn, whose shorter way is not unique, or a way that overflows: the
                  ///< edge defines no curve
  rounding,       ///< the rounding of large values takes more than half of the tolerance
  floatingPoint,  ///< the processor is set so that no bound holds (core/floating_point.h)
};

/// The answer of a motion query (design: contract 2). `free` is never wrong. `contact` has an exact
/// contact at the rounded pose at `contactTime`. `undecided` has a reason.
struct MotionResult {
  MotionVerdict verdict = MotionVerdict::free;
  UndecidedReason reason = UndecidedReason::none;
  /// [0, certifiedUntil] is proved free (for `free`: 1), but where it is 0, which claims nothing.
  /// Not asked for: 0.
  double certifiedUntil = 1;
  double contactTime =
      -1;  ///< t1 of `contact`, else −1; for `undecided` the middle of the undecided interval
  bool grazing = false;  ///< `contact`, and over all of [certifiedUntil, contactTime] the clearance
                         ///< stays under twice the tolerance, rounding and tube. Not asked for:
                         ///< false.
  std::optional<Contact> pair;  ///< of `contact`, and of `undecided` for want of clearance
  double gap = 0;  ///< `undecided` for want of clearance: distance beyond the margin found at
                   ///< contactTime, metres
};

/// Parameters of a motion query.
struct MotionOptions {
  double tolerance = 0;   ///< metres, > 0; below this clearance the answer may be `undecided`
  double margin = 0;      ///< metres kept from every obstacle; 0: touching is contact
  double reserve = 0;     ///< metres that `free` leaves beyond margin and tube; less is `undecided`
  bool earliest = false;  ///< find `certifiedUntil` too, not just the verdict
  /// Of [0, 1]; how narrow a bracket `earliest` asks for. In that time the bodies should come
  /// nearer by more than a few tolerances: else the bracket's beginning is closer than can be
  /// proved free, and a plain contact is `grazing` or `undecided`.
  double timeTolerance = 1.0 / 1024;
  /// Box and triangle tests, soon after which (a pair of nodes: 16 and 256 at most) the answer is
  /// `undecided`.
  std::uint64_t workLimit = 20'000'000;
  /// What is walked. Bodies' own bounds, looked at before any tree, are the same for all kinds.
  TreeKind trees = TreeKind::wideObb;
};

/// The relative motions along an edge, numbered by whoever owns it: as many as there are pairs of
/// frames that move differently. May keep scratch memory: one thread at a time.
class MotionSource {
 public:
  virtual ~MotionSource() = default;
  /// Motion `i` in [t − h, t + h], outside of [0, 1] as if it went on. @pre 0 ≤ t ≤ 1, h ≤ 1/2,
  /// t − h and t + h exact. The span stays good until the next call for the same i.
  virtual MotionWindow window(std::size_t i, double t, double h) = 0;
  /// The shorter way is not unique within 1e-9 rad somewhere (half turns), or overflows: no edge.
  virtual bool ambiguous() const = 0;
  /// Nothing moves: one pose stands for all of it (the tube aside).
  virtual bool still() const = 0;

 protected:
  MotionSource() = default;
  MotionSource(const MotionSource&) = default;
  MotionSource& operator=(const MotionSource&) = default;
};

/// Two bodies, b moving as seen from a by `motion`, and their indices in the scene.
struct MotionPair {
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  const Body* a;
  const Body* b;
  std::size_t motion = 0;
  std::size_t bodyA = 0, bodyB = 0;
  /// The motions of a and of b as the world sees them, where they are numbered: pairs that are far
  /// apart are told by them, once a body instead of once a pair. `worldA` is none where a is at
  /// rest in the world, and `worldB` is `motion` then; both are none where nothing is known. Where
  /// they are given, a body's index and its motion are the same in all pairs of a query.
  std::size_t worldA = kNone, worldB = kNone;
};

/// Proved: all through [t0, t1], and for the tube around it, pair `pair` of a query stays at least
/// `clearance` metres apart. At least margin and reserve; what was asked for is in it.
struct FreeInterval {
  std::size_t pair = 0;
  double t0 = 0, t1 = 0;
  double clearance = 0;
};

/// Why an answer is what it is. Of a query without `earliest` whose answer isn't `free`: what was
/// proved until then.
struct MotionEvidence {
  /// Of each pair they cover [0, certifiedUntil] without a gap, not in order; and maybe more.
  std::vector<FreeInterval> free;
  /// Of `contact`: a point of body a where the two touch (with a margin: where they are closest),
  /// in a's frame, metres, at `contactTime`; off by rounding of their coordinates.
  std::optional<Vec3> point_A;
};

/// Is the motion free of contact of every pair, for all t in [0, 1], for the tube around it, and
/// with the margin kept? Surfaces of meshes: one inside another touches nothing (`Scene` knows of
/// solids); primitives are solid. Pairs of one motion, and of these
/// the ones of one b, are best put side by side.
///
/// Method (design: «The certified edge»): a window of time is halved where boxes or leaves can't
/// be told apart (`descend`: descend.h, and, for any volume, descend_volumes.h); each window hands
/// the undecided pairs of nodes down to its halves. Bodies whose bounds stay apart are never
/// descended, nor do they get a tree. Where only the verdict is asked for, those whose bounds don't
/// are tested for contact at the end before any window is walked, and what the first windows leave,
/// in their middles: most motions that touch anything are done there.
/// @param evidence  where not null, gets why: `checkEvidence` (check_evidence.h) proves it anew. No
/// verdict depends on it; it takes half again the time.
MotionResult certifyMotion(MotionSource& motion, std::span<const MotionPair> pairs,
                           const MotionOptions& options, QueryContext& context,
                           MotionEvidence* evidence = nullptr);

}  // namespace corridor
