#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "collision/core/query_context.h"
#include "collision/core/rounding.h"
#include "collision/motion/broad_phase.h"
#include "collision/motion/certify_motion.h"
#include "collision/motion/descend.h"
#include "collision/motion/interval_motions.h"
#include "collision/motion/work_list.h"
#include "collision/queries/triangle_pair.h"

namespace corridor {

/// A time interval with its work: a range of `WorkList::groups`. These are the groups that the
/// parent interval did not separate; for the whole motion, all groups.
struct Interval {
  double t0, t1;
  std::size_t begin, end;
  WorkList::Mark mark = {};      ///< the work list is cut here before the interval is tested
  bool boundsAreTested = false;  ///< the bounds of whole bodies have been tested in this interval

  double half() const { return (t1 - t0) / 2; }
  double middle() const { return t0 + half(); }  // dyadic: exact
};

/// The arguments of a motion query, and what is computed from them once.
struct MotionQuery {
  std::span<const MotionPair> pairs;
  const MotionOptions& options;
  QueryContext& context;
  MotionCertificate* certificate;  ///< null if none is requested
  std::uint64_t workEnd;           ///< `Counters::work` at which the query stops
  const BroadPhase* broadPhase;    ///< the broad phase of `pairs`, or null

  /// Returns the distance, metres, that the bodies of a pair must exceed to be proved free.
  double requiredDistance(std::size_t pair) const {
    return roundedUp(options.marginOf(pair) + options.clearanceSlack);
  }
  /// Returns the largest `requiredDistance`.
  double largestRequiredDistance() const {
    return roundedUp(options.largestMargin() + options.clearanceSlack);
  }
};

/// The result of testing one interval.
struct IntervalAnswer {
  Descent found;  ///< the kind is `done` if nothing stopped the test
  /// If the kind is not `done`: the number of the pair of bodies at which the test stopped.
  std::uint32_t bodies = 0;
};

/// Tests the groups of the interval. Appends to the list the groups that cannot be separated and
/// the groups that were not tested. Records in the certificate what is proved. Returns what ended
/// the test.
IntervalAnswer decideInterval(const MotionQuery& query, const Interval& interval,
                              IntervalMotions& motions, WorkList& list);

/// Tests only the bounds of whole bodies, for the whole motion. Appends to the list the groups that
/// the bounds do not separate. Returns the whole motion as an interval with these groups as its
/// work.
/// @param far set to true if body b of one of these groups moves far
/// (`IntervalMotions::Separation`); otherwise not changed.
Interval testBodies(const MotionQuery& query, IntervalMotions& motions, WorkList& list, bool& far);

/// Tests only the bounds and the hulls of whole bodies in the interval, without trees. Appends to
/// the list the groups that shorter intervals may separate, and sets the entry in `left` of each
/// other pair that is not separated. Pairs whose entry is set already are not tested.
void separateBodies(const MotionQuery& query, const Interval& interval, IntervalMotions& motions,
                    WorkList& list, std::vector<bool>& left);

/// Tests the hulls of a group's bodies in the selected interval of `motions`. Returns an empty
/// answer for bodies without hulls, and for bodies whose trees have been walked, or whose hulls
/// met.
/// @param g the number of the group in the list.
/// @param slack metres, added to the errors of the motion.
MovingHullsAnswer testHulls(const MotionQuery& query, std::size_t g, double margin, double slack,
                            IntervalMotions& motions, WorkList& list);

/// Returns two leaf primitives (triangles or convex parts) that touch at the pose X_AB, by their
/// numbers in the meshes or lists; returns nothing if none are found. Tests the node pairs `start`
/// of the pair of bodies number `bodies`, and the last touching pair of these bodies (`LastPair`).
/// Gives up, and returns nothing, at the work limit or for a pose that overflows.
std::optional<PrimitivePair> contactBelow(const MotionQuery& query, std::uint32_t bodies,
                                          const Transform& X_AB, std::span<const NodePair4> start);

}  // namespace corridor
