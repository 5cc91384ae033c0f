#pragma once

#include <cstdint>

#include "collision/course/dobkin_kirkpatrick.h"
#include "collision/course/linear_program.h"

namespace corridor {

/// The signed separation of a polytope from the plane normal·x = offset, with its witness. Lengths
/// in the unit of the vertices.
struct PlaneSeparation {
  /// −1: all of the polytope is inside the half-space (normal·x < offset). 1: all of the polytope
  /// is outside. 0: the polytope meets or touches the plane. Exact.
  int side = 0;
  /// The vertices that are farthest inside and farthest outside the half-space. Exact.
  std::uint32_t innermost = 0, outermost = 0;
  /// The witness, which is `innermost` or `outermost`. If `side` is not 0, it is the vertex closest
  /// to the plane, exactly. If `side` is 0, the shortest translation that moves the polytope off
  /// the plane moves the witness onto the plane, up to rounding.
  std::uint32_t witness = 0;
  /// Bounds of the separation, which include all rounding. If `side` is not 0, the separation is
  /// the distance from the plane, and lower ≥ 0. If `side` is 0, the separation is minus the least
  /// depth, and upper ≤ 0. The depth is the length by which the polytope must move along the
  /// normal, or against it, until the polytope only touches the plane. A bound is infinite if the
  /// computed heights of vertices overflow.
  double lower = 0, upper = 0;
};

/// Returns the signed separation of a polytope from the boundary plane of a half-space, which is
/// given in the polytope's frame. O(log n).
///
/// Method: the hierarchy of projections (D. P. Dobkin, D. G. Kirkpatrick, Determining the
/// separation of preprocessed polyhedra: a unified approach, ICALP 1990; polytope_shadow.h). Onto
/// any plane that contains the normal, the polytope projects as a polygon, and the half-space's
/// plane as a line. The separation is the distance from that line of the highest or the lowest
/// vertex of the polygon. With h the signed height of a vertex over the plane, the separation is
/// max(h(innermost), −h(outermost)).
/// @throws std::invalid_argument if the normal is 0, or a number is not finite.
PlaneSeparation planeSeparation(const DobkinKirkpatrick& polytope, const HalfSpace<3>& halfSpace);

/// Returns only `PlaneSeparation::side`, exactly. The search goes from the coarsest polytope of the
/// hierarchy to finer ones. It ends at the first of these polytopes that has vertices on both sides
/// of the plane. This polytope is inside the given one, so the given polytope meets the plane.
/// @throws std::invalid_argument  as `planeSeparation`.
int sideOfPlane(const DobkinKirkpatrick& polytope, const HalfSpace<3>& halfSpace);

}  // namespace corridor
