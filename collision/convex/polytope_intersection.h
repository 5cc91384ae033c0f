#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "collision/convex/dobkin_kirkpatrick.h"
#include "collision/convex/outer_hierarchy.h"
#include "collision/core/transform.h"

namespace corridor {

/// The answer whether two convex polytopes share a point, with its witness.
struct PolytopeIntersection {
  bool intersects = false;
  /// Set if neither `intersects` nor `exact`: a unit direction in the world, rounded. The
  /// projection of P onto it ends before that of Q begins, in real arithmetic.
  Vec3 direction_W = Vec3::Zero();
  /// Set if `intersects` and not `exact`: vertices of P and of Q whose hulls share a point already:
  /// O(log n) of them.
  std::vector<std::uint32_t> verticesP, verticesQ;
  int steps = 0;       ///< tests of a part of P against a part of Q
  bool exact = false;  ///< not decided by this witness, but by `convexHullsTouch`
};

/// What holds after a step of the algorithm, in Q's frame.
struct PolytopePruning {
  std::size_t levelP, levelQ;  ///< P_i of the inner, Q_j of the outer hierarchy
  bool apart;                  ///< which of the two invariants holds:
  /// `apart`: normal·x ≤ offset on P_i, and normal·x ≥ offset on Q_j. The vertices of P that must
  /// still be examined are beyond this plane.
  Vec3 normal_Q;
  double offset;
  /// Not `apart`: a point of P_i and Q_j. The half-spaces of Q that must still be examined are
  /// those that exclude this point.
  Vec3 point_Q;
};

/// Tests two convex polytopes, each preprocessed by itself and under its own affine map, for a
/// common point: O(log |P| + log |Q|) steps of constant time. Touching counts. The verdict is
/// exact, in real arithmetic on the given doubles, for any finite maps.
///
/// Method: L. Barba, S. Langerman, Optimal detection of intersections between convex polyhedra
/// (SODA 2015), in space: its hierarchies and its two invariants; the step of constant time is
/// derived here. P_i is the inner hierarchy of P, Q_j the outer one of Q, and i and j only
/// decrease. One of two invariants holds:
/// * Separation: a plane h separates P_i from Q_j. At most one vertex v of P_{i−1} is beyond h,
///   because such vertices are no neighbours. All of P_{i−1} beyond h is in the hull of v and its
///   neighbours. If no vertex is beyond h down to P_0, the polytopes are disjoint.
/// * Intersection, the same in the polar space: a point x is in P_i and Q_j. At most one half-space
///   H of Q_{j−1} excludes x. If none does down to Q_0, x is common to both.
///
/// Let T_P be the hull of v, its neighbours, and the last x; and T_Q the half-spaces H, its
/// neighbours, and the half-space beyond the last h: at most ten each.
/// * If T_P and T_Q are apart, by a plane g, then the plane through v and the line where g meets h
///   separates P_{i−1} from T_Q, and so from Q. (Let h, g ≤ 0 on the side of P. For y of P_{i−1}
///   with h(y) < 0 and g(y) > 0, the segment to v meets h = 0 in the hull of v and its neighbours,
///   where g ≤ 0. So y is below this plane.) It is the next h, and i decreases.
/// * If they share a point, the segment to it from the last x meets the plane of H in the face of
///   Q_{j−1}, for the polar reason. This point is the next x, and j decreases.
///
/// The invariants hold in real arithmetic on exact hierarchies. The search runs in double, on polar
/// points that are rounded, so each answer is proved afterwards: "disjoint" by certified
/// projections along h (`PosedSet::highest`), "intersects" by an exact contact test of the few
/// vertices used (exact_contact.h). If that fails (bodies that touch or nearly touch, mostly; or if
/// Q has no polar), the exact contact test of the whole polytopes decides. It has no logarithmic
/// bound. The proof of "disjoint" needs one farthest vertex of each polytope, in O(log n); the
/// proof of "intersects" runs GJK on O(log n) vertices.
/// @param trace  if not null, receives what holds after each step that prunes.
/// @throws std::invalid_argument if a map is not finite.
PolytopeIntersection intersection(const DobkinKirkpatrick& p, const Transform& X_WP,
                                  const OuterHierarchy& q, const Transform& X_WQ,
                                  std::vector<PolytopePruning>* trace = nullptr);

}  // namespace corridor
