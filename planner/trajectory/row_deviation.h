#pragma once

#include <vector>

#include "planner/trajectory/law_clock.h"

namespace corridor {

/// Returns a bound of the distance between the curve of two rows and the path, at equal times of
/// the law. The distance is the larger of two values: the largest difference of a component (rad or
/// m), and the largest angle between two rotations (rad). `first` and `last` are the rows at the
/// times `from` and `to`. The difference of the two curves is a polynomial on each segment of the
/// law; the Bernstein coefficients of this polynomial bound it. Rounding, some 2^-50 of the
/// positions, is not included.
/// @pre If the space has rotations, both rows are in one run, so that each rotation keeps its axis.
double rowDeviation(const std::vector<LawSegment>& segments, const PathView& view,
                    const LawTime& from, const LawTime& to, const TimedRow& first,
                    const TimedRow& last, int degree);

}  // namespace corridor
