#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "collision/core/query_context.h"
#include "collision/motion/certify_motion.h"
#include "collision/motion/descend.h"
#include "collision/motion/interval_motions.h"
#include "collision/motion/work_list.h"
#include "collision/queries/triangle_pair.h"

namespace corridor {

/// A time interval, and the range of `WorkList::groups` that is its work: what the interval that it
/// is a half of could not separate.
struct Interval {
  double t0, t1;
  std::size_t begin, end;
  WorkList::Mark mark = {};      ///< where the work list is cut before the interval is tested
  bool bodiesAreTested = false;  ///< the bounds of all bodies were tested in it

  double half() const { return (t1 - t0) / 2; }
  double middle() const { return t0 + half(); }  // dyadic: exact
};

/// Limits on the work in one interval, since an interval that is far too wide should be halved
/// before all of its pairs are tested.
struct SplitThresholds {
  unsigned pairsOfNodes;  ///< the walk of a pair of bodies stops once it has left this many
  /// The test of an interval leaves the remaining bodies untested once this many pairs of bodies
  /// have left something, and these are more than three quarters of the pairs tested.
  std::size_t pairsOfBodies;
};

/// What decides when a query halves an interval. No value affects a verdict, except that
/// `kShortest` bounds what can be decided; all were chosen by measurements (MEASURED.md).
struct SplitRules {
  /// The whole motion is mostly too wide, so its thresholds are the lowest, but only if b rotates:
  /// a translation is described exactly to first order in any interval.
  static constexpr SplitThresholds kFirst = {1, 1}, kLater = {8, 4};
  /// The least half width at which a body that moves far (`IntervalMotions::Separation`) is left to
  /// the interval's halves untested. Below it every body is tested: pairs that are left untested
  /// count no work, and a joint may make any number of turns, so the query might otherwise never
  /// reach its work limit.
  static constexpr double kShortestFar = 0x1p-8;
  /// The number of levels of halving that are walked level by level if only the verdict is
  /// requested, so that a contact anywhere is found early.
  static constexpr int kFirstLevels = 4;
  /// The number of levels below the whole motion at whose middles the remaining pairs are tested
  /// for contact. Measured on the edges that plans test: one more level costs more than it finds.
  static constexpr int kSampledLevels = 2;
  /// Intervals with a half width of 2^-48 of the motion are not halved: much below, their middles
  /// would no longer be exact.
  static constexpr double kShortest = 0x1p-48;
};

/// The parts of a motion query that do not change while it runs.
struct MotionQuery {
  std::span<const MotionPair> pairs;
  const MotionOptions& options;
  QueryContext& context;
  MotionCertificate* certificate;  ///< null if none is requested
  std::uint64_t workEnd;           ///< of `Counters::work`
};

/// The result of testing one interval.
struct IntervalAnswer {
  Descent found;             ///< the kind is `done` if nothing stopped the test
  std::uint32_t bodies = 0;  ///< otherwise the number of the pair of bodies that it is about
};

/// Tests the interval's work. Appends to the list what it cannot separate, and what it did not
/// test. Records in the certificate what it proves.
IntervalAnswer testInterval(const MotionQuery& query, const Interval& interval,
                            IntervalMotions& motions, WorkList& list);

/// Tests only the bounds of all bodies in the whole motion. Appends the groups that they do not
/// separate, and returns them as an interval.
/// @param far  set if any of these bodies moves far in it
Interval testBodies(const MotionQuery& query, IntervalMotions& motions, WorkList& list, bool& far);

/// Returns the triangles that touch at the pose X_AB below the node pairs `start` of pair number
/// `bodies`, by their numbers in the meshes, or nothing. Gives up at the work limit. A pose that
/// overflows touches nothing.
std::optional<TrianglePair> touchBelow(const MotionQuery& query, std::uint32_t bodies,
                                       const Transform& X_AB, std::span<const NodePair4> start);

}  // namespace corridor
