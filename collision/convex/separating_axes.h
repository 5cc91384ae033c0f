#pragma once

#include <cstddef>

#include "collision/convex/polytope_features.h"

namespace corridor {

/// The answer of the separating-axis test of two polytopes.
struct SeparatingAxis {
  bool separated = false;  ///< the polytopes share no point
  /// If separated, what proves it. A face of one and a vertex of the other: the vertex is beyond
  /// the plane of the face, and no point of its polytope is nearer to the plane. Or two edges: the
  /// two planes through them that are parallel to both have the polytopes on their outer sides.
  /// So `a` is a face and `b` a vertex, or the other way round, or both are edges.
  Feature a, b;
  Vec3 normal_W = Vec3::Zero();  ///< the axis, from a to b: unit, rounded; zero if not separated
  std::size_t faces = 0;         ///< number of axes tested that are normals of faces
  std::size_t edgePairs = 0;     ///< number of axes tested that are products of two edges
};

/// Tests whether two convex polytopes share a point, by the separating-axis theorem: if not, one of
/// the normals of their faces, or the cross product of an edge of each, separates them. Touching is
/// contact. The verdict is exact, in real arithmetic on the given doubles: each sign of a
/// determinant is computed in double with a bound of its error, and in integers if that does not
/// decide.
///
/// Method: the axis of two edges is tested only if the edges form a face of the Minkowski
/// difference: if the arcs between the normals of their faces cross on the Gauss map (D. Gregorius,
/// The Separating Axis Test between Convex Polyhedra, GDC 2013). That edge pair's axis needs no
/// projection of other points. Every face of the Minkowski difference has the normal of a face of
/// one of the two, or comes from two edges whose arcs cross in their interiors. So the pruning
/// loses nothing, and parallel edges and coplanar faces need no special rules.
///
/// Cost: O(F V) for the faces, and O(F E + E²) for the edges. That pays for small polytopes only
/// (README.md). Memory: O(V + F), allocated in each query.
/// @param first  if not null, the features of an earlier answer, whose axis is tested first.
/// @throws std::invalid_argument if a map is not finite, mirrors, or flattens or nearly does: if
/// its determinant is at most 2^-40·‖M‖_F³, computed in double.
SeparatingAxis separatingAxis(const PolytopeFeatures& a, const Transform& X_WA,
                              const PolytopeFeatures& b, const Transform& X_WB,
                              const SeparatingAxis* first = nullptr);

}  // namespace corridor
