#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "collision/convex/convex_polygon.h"

namespace corridor {

/// Whether two convex polygons share a point, with the witness that proves the answer.
struct PolygonIntersection {
  bool intersects = false;
  /// If `intersects` is false: a direction along which the projection of q begins beyond the end of
  /// the projection of p. If `exact` is false, this is proved in real arithmetic for the stored
  /// direction. If `exact` is true, separatingPlane has decided, and the direction is its rounded
  /// normal.
  Vec2 direction = Vec2::Zero();
  /// If `intersects` is false: the vertex of p that is extreme along the direction, and the vertex
  /// of q that is extreme against the direction.
  std::size_t p = 0, q = 0;
  /// If `intersects` is true: vertices of p and of q whose hulls already share a point; O(log n) of
  /// each.
  std::vector<std::size_t> verticesP, verticesQ;
  int steps = 0;
  bool exact = false;  ///< the answer needed all vertices (separating_plane.h)
};

/// The parts of both polygons that can still decide the answer after a step of the algorithm. `p`
/// is the chain of vertices from p[0] to p[1], `q` the chain of edges from q[0] to q[1],
/// counterclockwise. An edge has the index of its first vertex. If no part of a polygon is pruned,
/// the second index is the first plus the polygon's number of vertices.
struct PolygonPruning {
  std::array<std::size_t, 2> p, q;
};

/// Tests two convex polygons, P = p and Q = q, for a common point in O(log |P| + log |Q|), where
/// |P| is the number of vertices. Touching counts. Exact, in real arithmetic on the given doubles.
/// For coordinates beyond some 2^±480 m the test takes O(|P| + |Q|).
///
/// Method: L. Barba, S. Langerman, Optimal detection of intersections between convex polyhedra
/// (SODA 2015), section 3. P is represented by T_P, a triangle of three vertices of P, which is
/// inside P. Q is represented by its *edge hull* T_Q: the half-planes of some of its edges, which
/// contain Q.
/// * If T_P and T_Q are apart, a line separates them, and touches T_P at a vertex. At most one of
///   the two chains of P next to this vertex reaches beyond the line. All vertices outside of this
///   chain are pruned.
/// * If T_P and T_Q share points, there are two cases. Either some of these points are in Q, or all
///   of them are beyond one chain of edges of Q, between two edges of T_Q. In the second case P
///   meets Q if and only if P meets the intersection of the half-planes of this chain. All edges
///   outside of this chain are pruned.
///
/// Each step prunes half of a chain, so P or Q loses half of what is left. (The first step of Q
/// leaves a chain that turns by less than a quarter turn.) The steps are done in double. The answer
/// is then proved exactly, by its witness. "Disjoint" is proved by the extreme vertices along the
/// separating direction, "intersects" by linear programming with the vertices that the algorithm
/// has used. If this proof fails, separatingPlane (separating_plane.h) decides, in O(n).
/// @param trace  if not null, receives the remaining parts after each step.
PolygonIntersection intersection(const ConvexPolygon& p, const ConvexPolygon& q,
                                 std::vector<PolygonPruning>* trace = nullptr);

}  // namespace corridor
