#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "collision/core/rounding.h"
#include "collision/core/transform.h"
#include "collision/hierarchy/tree_kinds.h"

/// The questions and answers of motion queries. certify_motion.h has the query.
namespace corridor {

class Body;
struct BoundingBox;
struct RelativeMotion;

/// Two bodies, by their indices in the scene, and one triangle of each body, by its number in the
/// mesh. The two triangles touch, or are within the margin; in an undecided answer, they could not
/// be decided. For a body of convex parts, the number is that of a part.
struct Contact {
  std::size_t bodyA = 0, bodyB = 0;
  std::uint32_t primitiveA = 0, primitiveB = 0;
};

enum class MotionVerdict { free, contact, undecided };
enum class UndecidedReason {
  none,
  clearance,  ///< the clearance is below twice the tolerance somewhere
  workLimit,  ///< the query reached its work limit
  /// The edge defines no curve: it has a half turn, whose shorter way is not unique, a displacement
  /// that overflows, or a number that is not finite.
  ambiguous,
  rounding,       ///< the rounding of large values takes more than half of the tolerance
  floatingPoint,  ///< no bound holds with these processor settings (core/floating_point.h)
  /// The motion leaves the configurations for which pairs that the caller left out are proved apart
  /// (planner/model/pair_proofs.h). No query of this library gives this reason.
  beyondProofs,
};

/// The words for results: "free", "work_limit"; "" for `none`.
const char* nameOf(MotionVerdict verdict);
const char* nameOf(UndecidedReason reason);

/// The answer of a motion query (collision/PROMISES.md, promise 2). `free` is never wrong.
/// `contact` is decided at the rounded pose at `time`, for meshes exactly. `undecided` has a
/// reason.
struct MotionResult {
  MotionVerdict verdict = MotionVerdict::free;
  UndecidedReason reason = UndecidedReason::none;
  /// The motion is proved free on [0, certifiedUntil]. 1 if the verdict is `free`. With any other
  /// verdict, 0 if nothing was proved, or if the query did not set `MotionOptions::earliest`.
  double certifiedUntil = 1;
  /// `contact`: the time of the contact. `undecided`: a time in the interval that could not be
  /// decided (its middle, if the method is the default). −1 if there is no such time.
  double time = -1;
  /// True only for `contact`. Then, on all of [certifiedUntil, time], the clearance is below
  /// the sum of twice the tolerance, the rounding and the tube. Always false without `earliest`.
  bool grazing = false;
  /// The pair in contact; `undecided`: the pair that could not be decided, if it is known.
  std::optional<Contact> pair;
  /// `undecided` with a `pair`: the distance of this pair at `time`, beyond the margin,
  /// metres; 0 if it was not measured.
  double gap = 0;
};

/// One margin for each pair of a query, in addition to `MotionOptions::margin`. Pair margins serve
/// to pad bodies, and to prove that each pair keeps a distance of its own.
class PairMargins {
 public:
  /// @param metres one margin for each pair of the query, in the query's order; for queries of a
  /// `Scene`, the order of `Scene::pairs()`, which is also that of `Scene::motionPairs()`.
  /// @throws std::invalid_argument if a margin is negative or not finite. (The margins are tested
  /// here, and not by each query, because scenes may have millions of pairs.)
  explicit PairMargins(std::vector<double> metres);

  std::size_t size() const { return metres_.size(); }
  double operator[](std::size_t pair) const { return metres_[pair]; }
  const std::vector<double>& all() const { return metres_; }
  double largest() const { return largest_; }

 private:
  std::vector<double> metres_;
  double largest_ = 0;
};

/// The parameters of a motion query.
struct MotionOptions {
  /// Metres, above 0. The caller must set it. A motion whose clearance beyond margin and tube is
  /// below twice the tolerance may be `undecided`.
  double tolerance = 0;
  double margin = 0;  ///< metres that all pairs must keep apart; 0: touching is contact
  /// Metres that single pairs must keep apart in addition to `margin`, one for each pair of the
  /// query; null: none. Not owned.
  const PairMargins* pairMargins = nullptr;
  /// The numbers of the pairs that are tested, in ascending order; null: all. The caller has proved
  /// that the others keep their margins and the clearance slack on the whole motion, and that none
  /// of their bodies is inside a solid one. Not for queries with a certificate. Not owned.
  const std::vector<std::uint32_t>* only = nullptr;
  /// Clearance slack, metres: the clearance beyond margin and tube that `free` requires. A motion
  /// with less clearance is never `free`.
  double clearanceSlack = 0;
  bool earliest = false;  ///< find `certifiedUntil` too, not just the verdict
  /// With `earliest`: the largest width of the bracket [certifiedUntil, time], as a fraction
  /// of the motion. Choose it so that, during this fraction of the motion, the bodies approach each
  /// other by more than a few tolerances. Otherwise the beginning of the bracket is too close to
  /// the contact to be proved free. A contact that would not graze with a larger `timeTolerance` is
  /// then reported as `grazing`, or the motion as `undecided`.
  double timeTolerance = 1.0 / 1024;
  /// Number of box and triangle tests after which the answer is `undecided`. The default method
  /// stops at most one node pair later, which is at most 16 box tests and 256 triangle tests.
  std::uint64_t workLimit = 20'000'000;
  /// The kind of trees to walk. The bounds of whole bodies, which are tested before any tree, are
  /// the same for all kinds.
  TreeKind trees = TreeKind::obb4;
  /// Whether the convex hulls of bodies that come near each other are tested before their trees.
  /// Only the default method on the default trees does so. The promises are the same without;
  /// without, it takes longer.
  bool hulls = true;

  /// Returns the distance that a pair must keep, metres, rounded up.
  double marginOf(std::size_t pair) const {
    const double more = pairMargins ? (*pairMargins)[pair] : 0;
    return more > 0 ? roundedUp(margin + more) : margin;
  }
  /// Returns an upper bound of `marginOf` for all pairs, metres.
  double largestMargin() const {
    const double more = pairMargins ? pairMargins->largest() : 0;
    return more > 0 ? roundedUp(margin + more) : margin;
  }
};

/// Checks the options of a motion query of `pairs` pairs. Every motion query calls it: with a
/// negative margin, for example, `free` would be possible although bodies touch.
/// @throws std::invalid_argument if tolerance or time tolerance is not positive and finite, if
/// margin or clearance slack is negative or not finite, or if there is not one margin for each
/// pair.
void requireValid(const MotionOptions& options, std::size_t pairs);

/// The relative motions along an edge. Each distinct relative motion of two frames has a number,
/// which the implementation defines. An object may hold scratch memory, so only one thread may use
/// it at a time.
class MotionSource {
 public:
  virtual ~MotionSource() = default;
  /// Returns motion `i` in [t − h, t + h]. Outside [0, 1] the motion is continued. The span in the
  /// result stays valid until the next call for the same `i`. @pre 0 ≤ t ≤ 1, h ≤ 1/2; t − h and t
  /// + h are exact.
  virtual RelativeMotion relativeMotion(std::size_t i, double t, double h) = 0;
  /// Returns true if the edge cannot be certified, for one of four reasons: a half turn (to within
  /// 1e-9 rad), whose shorter way is not unique; a displacement that overflows; a number of the
  /// edge that is not finite; unsuitable processor settings.
  virtual bool ambiguous() const = 0;
  /// Reports whether nothing moves. The whole edge is then one pose, apart from the tube.
  virtual bool still() const = 0;

 protected:
  MotionSource() = default;
  MotionSource(const MotionSource&) = default;
  MotionSource& operator=(const MotionSource&) = default;
};

/// A pair of bodies, with their indices in the scene. Seen from a, b moves by motion number
/// `motion`.
struct MotionPair {
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  const Body* a;
  const Body* b;
  std::size_t motion = 0;
  std::size_t bodyA = 0, bodyB = 0;
  /// The numbers of the motions of a and of b as seen from the world, or `kNone`. With these
  /// numbers, a query needs only one swept sphere per body, not one per pair, to separate bodies
  /// that are far apart.
  /// * If a is at rest in the world (`restBox`), `worldMotionA` is `kNone`.
  /// * If a's frame is the world, `worldMotionB` equals `motion`.
  /// * If the motions are not known, both are `kNone`.
  /// * If they are known, a body has the same index in all pairs of a query, and the same number
  ///   for its motion as seen from the world.
  std::size_t worldMotionA = kNone, worldMotionB = kNone;
  /// A box around a in the world, if a is at rest there; else null. With the box and
  /// `worldMotionB`, a broad phase can find the pair.
  const BoundingBox* restBox = nullptr;
};

/// A proved statement: on all of [t0, t1], and for the whole tube around the motion, the two bodies
/// of pair number `pair` of a query stay at least `clearance` metres apart. The clearance includes
/// the margin and the clearance slack of the query, so it is at least their sum, rounded down.
struct FreeInterval {
  std::size_t pair = 0;
  double t0 = 0, t1 = 0;
  double clearance = 0;
};

/// The proof of an answer. If the query had no `earliest` and its answer is not `free`, the
/// certificate contains what was proved before the query stopped.
struct MotionCertificate {
  /// For each pair, these intervals cover [0, certifiedUntil] without a gap. The list may have
  /// further intervals. Its order is unspecified.
  std::vector<FreeInterval> free;
  /// `contact`: a point of body a where the two bodies touch (with a margin: where they are
  /// closest), in a's frame at `time`, metres. The point is off by the rounding of its
  /// coordinates.
  std::optional<Vec3> point_A;
};

}  // namespace corridor
