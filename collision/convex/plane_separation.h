#pragma once

#include <cstdint>

#include "collision/convex/dobkin_kirkpatrick.h"
#include "collision/convex/linear_program.h"

namespace corridor {

/// The signed separation of a polytope from the plane normal·x = offset, with its witness. Lengths
/// in the unit of the vertices.
struct PlaneSeparation {
  /// Exact: −1 all of the polytope is inside the half-space (normal·x < offset), 1 all of it is
  /// outside, 0 it meets the plane. Touching counts.
  int side = 0;
  /// Vertices that are farthest inside, and farthest outside: exact.
  std::uint32_t innermost = 0, outermost = 0;
  /// The one of them that is the witness: the vertex closest to the plane, exactly; or, if the
  /// polytope meets the plane, the vertex that the shortest translation off the plane brings onto
  /// it, up to rounding.
  std::uint32_t witness = 0;
  /// Bounds of the separation, which include all rounding: the distance from the plane if `side` is
  /// not 0, else minus the least depth, which is how far the polytope must move along the normal,
  /// or against it, until it only touches the plane. lower ≥ 0 if `side` is not 0, else upper ≤ 0.
  /// A bound is infinite if heights overflow.
  double lower = 0, upper = 0;
};

/// Returns the signed separation of a polytope from a plane in its own frame. O(log n).
///
/// Method: the hierarchy of projections (D. P. Dobkin, D. G. Kirkpatrick, Determining the
/// separation of preprocessed polyhedra: a unified approach, ICALP 1990; polytope_shadow.h). The
/// projection of the polytope onto a plane that contains the normal is a polygon, and the plane's
/// is a line. The separation is that of the highest or the lowest vertex of the polygon from the
/// line. With h the signed height of a vertex over the plane, it is max(h(innermost),
/// −h(outermost)).
/// @throws std::invalid_argument if the normal is 0, or a number is not finite.
PlaneSeparation planeSeparation(const DobkinKirkpatrick& polytope, const HalfSpace<3>& halfSpace);

/// Returns `side` of `planeSeparation` only: exact. Ends at the first, coarsest polytope of the
/// hierarchy that has vertices on both sides, because that polytope is inside.
/// @throws std::invalid_argument  as `planeSeparation`.
int sideOfPlane(const DobkinKirkpatrick& polytope, const HalfSpace<3>& halfSpace);

}  // namespace corridor
