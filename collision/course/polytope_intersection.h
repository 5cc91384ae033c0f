#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "collision/core/transform.h"
#include "collision/course/dobkin_kirkpatrick.h"
#include "collision/course/outer_hierarchy.h"

namespace corridor {

/// Whether two convex polytopes share a point, with the witness that proves the answer.
struct PolytopeIntersection {
  bool intersects = false;
  /// Set if both `intersects` and `exact` are false: a unit direction in the world, rounded. In
  /// real arithmetic, the projection of P onto this direction ends before the projection of Q
  /// begins.
  Vec3 direction_W = Vec3::Zero();
  /// Set if `intersects` is true and `exact` is false: O(log n) vertices of P and of Q whose hulls
  /// already share a point.
  std::vector<std::uint32_t> verticesP, verticesQ;
  int steps = 0;       ///< tests of a part of P against a part of Q
  bool exact = false;  ///< `convexHullsTouch` decided, and there is no witness
};

/// The invariant that holds after a step of the algorithm, in Q's frame.
struct PolytopePruning {
  std::size_t levelP,
      levelQ;  ///< i of P_i (inner hierarchy of P) and j of Q_j (outer hierarchy of Q)
  bool apart;  ///< true: the invariant "separation" holds; false: "intersection"
  /// Set if `apart`: normal_Q·x ≤ offset on P_i, and normal_Q·x ≥ offset on Q_j. The vertices of P
  /// that must still be examined are beyond this plane.
  Vec3 normal_Q;
  double offset;
  /// Set if not `apart`: a common point of P_i and Q_j. The half-spaces of Q that must still be
  /// examined are those that exclude this point.
  Vec3 point_Q;
};

/// Tests two convex polytopes, each under its own affine map, for a common point, in O(log |P| +
/// log |Q|) steps of constant time. Each polytope is preprocessed separately. Touching counts. The
/// verdict is exact, in real arithmetic on the given doubles, for any finite maps.
///
/// Method: L. Barba, S. Langerman, Optimal detection of intersections between convex polyhedra
/// (SODA 2015), in space. The hierarchies and the two invariants are those of the paper; the step
/// of constant time is derived here. P_i is the inner hierarchy of P, Q_j the outer one of Q, and i
/// and j only decrease. One of two invariants holds:
/// * Separation: a plane h separates P_i from Q_j. At most one vertex v of P_{i−1} is beyond h,
///   because the vertices that P_{i−1} has and P_i lacks are not neighbours of one another. The
///   part of P_{i−1} beyond h is in the hull of v and its neighbours. If no vertex is beyond h down
///   to P_0, the polytopes are disjoint.
/// * Intersection, which is separation in the polar space: a point x is in P_i and Q_j. At most one
///   half-space H of Q_{j−1} excludes x. If no half-space excludes x down to Q_0, x is in both
///   polytopes.
///
/// Let T_P be the hull of at most ten points: v, the neighbours of v, and the latest x. Let T_Q be
/// the intersection of at most ten half-spaces: H, the neighbours of H, and the half-space beyond
/// the latest h.
/// * If T_P and T_Q are apart, by a plane g, then the plane through v and the line where g meets h
///   separates P_{i−1} from T_Q, and so from Q. (Let h, g ≤ 0 on the side of P. For y of P_{i−1}
///   with h(y) < 0 and g(y) > 0, the segment to v meets h = 0 in the hull of v and its neighbours,
///   where g ≤ 0. So y is below the plane through v.) That plane is the next h, and i decreases.
/// * If T_P and T_Q share a point, the segment from the latest x to this point meets the plane of H
///   in a point of the face of Q_{j−1}, by the polar argument. That point of the face is the next
///   x, and j decreases.
///
/// The invariants hold in real arithmetic on exact hierarchies. The search runs in double, on polar
/// points that are rounded, so each answer is proved afterwards: "disjoint" by certified
/// projections along h (`PosedSet::highest`), "intersects" by an exact contact test of the few
/// vertices used (exact_contact.h). This proof fails mostly for bodies that touch or nearly touch.
/// If it fails, or if Q has no polar, the exact contact test of the whole polytopes decides. That
/// test has no logarithmic bound. The proof of "disjoint" needs one farthest vertex of each
/// polytope, in O(log n); the proof of "intersects" runs GJK on O(log n) vertices.
/// @param trace  if not null, receives the invariant after each step that prunes.
/// @throws std::invalid_argument if a map is not finite.
PolytopeIntersection intersection(const DobkinKirkpatrick& p, const Transform& X_WP,
                                  const OuterHierarchy& q, const Transform& X_WQ,
                                  std::vector<PolytopePruning>* trace = nullptr);

}  // namespace corridor
