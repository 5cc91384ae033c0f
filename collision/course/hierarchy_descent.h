#pragma once

#include "collision/convex/convex_distance.h"
#include "collision/course/dobkin_kirkpatrick.h"

namespace corridor {

/// Minimum separation and directional depth of two polytopes by a descent in both hierarchies, as
/// Dobkin and Kirkpatrick describe it. (`convexDistance` and `penetrationAlong` use the hierarchies
/// only to find farthest vertices; they are faster.)
///
/// The hierarchy of P has the polytopes P_k ⊂ … ⊂ P_1 ⊂ P_0 = P. P_{i−1} is P_i together with a
/// pyramid over each removed vertex. A query keeps the best answer for P_i, and the supporting
/// plane of P_i that proves it. Beyond this plane lies at most one of the pyramids: that part of
/// P_{i−1} is convex, and the pyramids meet only in P_i. The pyramid's apex is the farthest vertex
/// along the normal of the plane. So the answer for P_{i−1} is the better one of two: that for P_i,
/// and that for the one pyramid, which has at most 8 neighbours of its apex. For this pyramid and
/// Q, the same descent is made in the hierarchy of Q. O(log² n) steps, or O(log³ n) if every step
/// changes the plane: the farthest vertex along a new normal is then searched from the top. At the
/// end, the plane of the answer must support both polytopes. Where rounding or parallel faces have
/// lost a pyramid, it does not; then the answer is computed from all vertices, in O(n).
///
/// Sources: D. P. Dobkin, D. G. Kirkpatrick, Determining the separation of preprocessed polyhedra:
/// a unified approach, ICALP 1990; D. Dobkin, J. Hershberger, D. Kirkpatrick, S. Suri, Computing
/// the intersection-depth of polyhedra, Algorithmica 9 (1993).
///
/// @param pieces  in both queries: if not null, is set to the number of pairs of pyramids tested.

/// Computes the distance of two polytopes under their maps. `distance` is that of two points of
/// the polytopes, rounded, and 0 only if the polytopes touch (`convexSetsTouch`). `lower` is proved
/// as in `convexDistance`: they are apart if it is above 0.
ConvexDistance distanceByDescent(const DobkinKirkpatrick& a, const Transform& X_WA,
                                 const DobkinKirkpatrick& b, const Transform& X_WB,
                                 int* pieces = nullptr);

/// The depth of two polytopes along a direction; metres.
struct DepthByDescent {
  /// After a move of b by `upper` along the direction, the polytopes at most touch; proved. If they
  /// are apart, but b hits a on its way, `upper` is where b has left a again; 0 only if it never
  /// hits a. HUGE_VAL if the numbers overflow; tight for coordinates from 2^-440 to 2^440
  /// (PosedSet).
  double upper = 0;
  /// The depth that was found, rounded. It is less than `upper` by more than rounding only if the
  /// touching surfaces have a slope beyond 2^20 against the direction.
  double found = 0;
  Vec3 normal_W = Vec3::Zero();  ///< of the plane that proves `upper`, from a to the moved b: unit
};

/// Computes the length by which b must move along the direction to leave a. For a pair of pyramids,
/// a linear program in 4 variables (convex/seidel-inl.h) finds the plane that gives the length.
/// @throws std::invalid_argument if the direction is 0, or it or a map is not finite.
DepthByDescent depthByDescent(const DobkinKirkpatrick& a, const Transform& X_WA,
                              const DobkinKirkpatrick& b, const Transform& X_WB,
                              const Vec3& direction, int* pieces = nullptr);

}  // namespace corridor
