#pragma once

#include <vector>

#include "planner/trajectory/law_clock.h"

namespace corridor {

/// Returns a bound of the distance between the curve of two rows and the path at the law's times,
/// in each number (rad, m; rotations: the angle). `first` and `last` are the rows at the times
/// `from` and `to`. The difference of the two curves is a polynomial on each segment of the law;
/// its Bernstein coefficients bound it. Rounding is not included; it is some 2^-50 of the
/// positions.
/// @pre if there are rotations: both rows are in one run, so that each rotation keeps its axis.
double rowDeviation(const std::vector<LawSegment>& segments, const PathView& view,
                    const LawTime& from, const LawTime& to, const TimedRow& first,
                    const TimedRow& last, int degree);

}  // namespace corridor
