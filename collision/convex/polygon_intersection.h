#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "collision/convex/convex_polygon.h"

namespace corridor {

/// The answer whether two convex polygons share a point, with its witness.
struct PolygonIntersection {
  bool intersects = false;
  /// If not `intersects`: a direction along which the projection of q begins beyond the end of the
  /// projection of p. This is proved in real arithmetic, except if `exact` is set: then
  /// separatingPlane has decided exactly, and the direction is its rounded normal.
  Vec2 direction = Vec2::Zero();
  /// If not `intersects`: the vertices that are extreme, of p along the direction, of q against it.
  std::size_t p = 0, q = 0;
  /// If `intersects`: vertices of p and of q whose hulls already share a point; O(log n) of each.
  std::vector<std::size_t> verticesP, verticesQ;
  int steps = 0;
  bool exact = false;  ///< the answer needed all vertices (separating_plane.h)
};

/// What is left of both polygons after a step of the algorithm. `p` is the chain of vertices from
/// p[0] to p[1], `q` the chain of edges from q[0] to q[1], counterclockwise. An edge has the index
/// of its first vertex. If all of a polygon is left, the second index is the first plus the
/// polygon's size.
struct PolygonPruning {
  std::array<std::size_t, 2> p, q;
};

/// Tests two convex polygons for a common point in O(log |P| + log |Q|); touching counts. Exact, in
/// real arithmetic on the given doubles. Coordinates beyond some 2^±480 m take O(|P| + |Q|).
///
/// Method: L. Barba, S. Langerman, Optimal detection of intersections between convex polyhedra
/// (SODA 2015), section 3. P is represented by a triangle of its vertices, T_P, which is inside P.
/// Q is represented by its *edge hull* T_Q: the half-planes of some of its edges, which contain Q.
/// * If T_P and T_Q are apart, a line separates them, and touches T_P at a vertex. Only one chain
///   of P, next to this vertex, reaches beyond the line. The other vertices are pruned.
/// * If T_P and T_Q share points, some of these points are in Q, or all of them are beyond one
///   chain of Q, which is between two edges of T_Q. In the second case P meets Q if and only if it
///   meets the half-planes of this chain. The other edges are pruned.
///
/// Each step prunes half of a chain, so P or Q loses half of what is left. The steps are done in
/// double. The answer is then proved exactly, by its witness: by the extreme vertices along the
/// separating direction, or by linear programming with the vertices that the algorithm has used. If
/// this proof fails, separatingPlane (separating_plane.h) decides, in O(n).
/// @param trace  if not null, receives what is left after each step.
PolygonIntersection intersection(const ConvexPolygon& p, const ConvexPolygon& q,
                                 std::vector<PolygonPruning>* trace = nullptr);

}  // namespace corridor
