#pragma once

#include "collision/convex/polytope.h"
#include "collision/geometry/triangle_mesh.h"

namespace corridor {

/// The deviation of the convex hull of a mesh from the mesh: the largest distance, metres, of a
/// point of the hull's surface from the nearest point of the mesh.
struct HullDeviation {
  bool within = false;  ///< proved: the deviation is at most the given limit
  double upper = 0;     ///< if `within`: an upper bound of the deviation, rounding included
  double found = 0;     ///< the largest distance that was found, at the point `at`, up to rounding
  Vec3 at = Vec3::Zero();
};

/// Tests whether the deviation of a hull from its mesh is at most `limit`.
///
/// Method: branch and bound. The distance from one triangle of the mesh is a convex function, so on
/// a piece of the hull's surface it is largest at a corner of the piece. For each triangle, take
/// the largest distance of the piece's corners from it; the least of these values bounds the
/// deviation of the piece. A piece whose bound is above the limit is halved, or is cut along an
/// edge of the triangle with the least value, so that one part lies over that triangle. The search
/// ends at a corner that is farther than the limit from the mesh. It also ends, with `within` false
/// and `found` at most the limit, after 10^6 pieces, or at a piece that comes from 1000 cuts.
/// @pre all numbers are finite, the hull is that of the mesh's corners, and the limit is positive.
HullDeviation hullDeviation(const Polytope& hull, const TriangleMesh& mesh, double limit);

}  // namespace corridor
