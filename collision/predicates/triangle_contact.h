#pragma once

#include "collision/core/predicate_result.h"
#include "collision/predicates/triangle.h"

namespace corridor {

/// Returns whether two closed triangles, each under its own affine map, share a point.
///
/// Exact: the answer is that of real arithmetic on the given doubles, for any finite coordinates
/// and maps. Degenerate triangles count as the segments or points that they are. Touching is
/// contact. A filter in double with a proved error bound decides most cases. Integers decide the
/// others; then `PredicateResult::exact` is true.
///
/// Method: signs of orientation determinants as in Guigue, Devillers, "Fast and robust
/// triangle-triangle overlap test using orientation predicates", JGT 8(1), 2003. Degenerate
/// positions are decided by segment-triangle tests.
/// @pre all numbers are finite.
PredicateResult trianglesTouch(const Triangle& a, const Transform& X_WA, const Triangle& b,
                               const Transform& X_WB);

/// Returns the same answer without the filter in double. `trianglesTouch` calls this function if
/// the filter cannot decide; tests call it to check the filter.
bool trianglesTouchExact(const Triangle& a, const Transform& X_WA, const Triangle& b,
                         const Transform& X_WB);

}  // namespace corridor
