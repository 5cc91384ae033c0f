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
