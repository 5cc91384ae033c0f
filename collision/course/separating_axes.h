#pragma once

#include <cstddef>

#include "collision/course/polytope_features.h"

namespace corridor {

/// The answer of the separating-axis test of two polytopes.
struct SeparatingAxis {
  bool separated = false;  ///< the polytopes share no point
  /// If separated: the features of polytopes a and b that prove the separation. They are of one of
  /// two kinds:
  /// * A face of one polytope and a vertex of the other. The other polytope is beyond the plane of
  ///   the face, and no point of it is nearer to this plane than the vertex, up to rounding.
  /// * An edge of each polytope. Take the two parallel planes that are parallel to both edges, each
  ///   through one edge. Each polytope is on the outer side of the plane through its own edge.
  Feature a, b;
  Vec3 normal_W = Vec3::Zero();  ///< the axis, from a to b: unit, rounded; zero if not separated
  std::size_t faces = 0;         ///< number of axes tested that are normals of faces
  std::size_t edgePairs = 0;     ///< number of axes tested that are cross products of edges
};

/// Tests whether two convex polytopes share a point, by the separating-axis theorem. If they share
/// none, one of these axes separates them: the normal of a face, or the cross product of an edge of
/// one polytope and an edge of the other. Touching is contact. The verdict is exact, in real
/// arithmetic on the given doubles: each sign of a determinant is computed in double with a bound
/// of its error, and in integers if that does not decide.
///
/// Method: the axis of two edges is tested only if the edges form a face of the Minkowski
/// difference. They do if the arcs between the normals of their faces cross on the Gauss map (D.
/// Gregorius, The Separating Axis Test between Convex Polyhedra, GDC 2013). If two edges form such
/// a face, no other points need be projected onto their axis. Every face of the Minkowski
/// difference has the normal of a face of a polytope, or comes from two edges whose arcs cross in
/// their interiors. So the pruning loses nothing, and parallel edges and coplanar faces need no
/// special rules.
///
/// Cost, for polytopes of V vertices, E edges and F faces: O(F V) for the faces, and O(F E + E²)
/// for the edges. This cost is acceptable for small polytopes only (README.md). Memory: O(V + F),
/// allocated in each query.
/// @param first  if not null, the features of an earlier answer, whose axis is tested first.
/// @throws std::invalid_argument if a map is not finite, or if a map mirrors, flattens or nearly
/// flattens: its determinant, computed in double, is at most 2^-40·‖M‖_F³.
SeparatingAxis separatingAxis(const PolytopeFeatures& a, const Transform& X_WA,
                              const PolytopeFeatures& b, const Transform& X_WB,
                              const SeparatingAxis* first = nullptr);

}  // namespace corridor
