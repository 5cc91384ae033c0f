#pragma once

#include <cstddef>
#include <vector>

#include "planner/trajectory/limits_proof.h"
#include "planner/trajectory/path_view.h"
#include "planner/trajectory/time_law.h"

namespace corridor {

/// A time of a law: a segment, and the time since the begin of this segment.
struct LawTime {
  std::size_t segment = 0;
  double since = 0;  ///< seconds
};

/// Evaluates a path at times of a law.
class LawClock {
 public:
  LawClock(const std::vector<LawSegment>& segments, const PathView& view)
      : segments_(segments), view_(view) {}

  double timeOf(const LawTime& t) const { return segments_[t.segment].time + t.since; }
  LawTime at(double time) const;
  LawTime end() const { return {segments_.size() - 1, segments_.back().duration}; }
  /// Returns the row of the trajectory at a time: position, velocity and acceleration. At the end
  /// of the path and at ends of pieces, the position is the piece's first or last coefficient, bit
  /// for bit.
  TimedRow row(const LawTime& t) const;

 private:
  const std::vector<LawSegment>& segments_;
  const PathView& view_;
};

}  // namespace corridor
