#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "collision/core/transform.h"

namespace corridor {

/// A convex polytope: the hull of its vertices, with a triangulated boundary. Every vertex is an
/// extreme point of the hull, and no face is degenerate, in real arithmetic on the stored doubles.
/// Faces that are coplanar together form a larger face.
class Polytope {
 public:
  using Face = std::array<std::uint32_t, 3>;  ///< vertices, counterclockwise as seen from outside

  /// Builds the hull of the points. `vertices()` are the extreme points among them, in the given
  /// order.
  ///
  /// Method: quickhull (C. B. Barber, D. P. Dobkin, H. Huhdanpaa, 1996) with exact predicates, so
  /// nothing is merged or joggled. If points are coplanar, some vertices of this hull may not be
  /// extreme. Then the hull of the extreme vertices is computed once more. O(n log n) on usual
  /// points, O(n²) at worst.
  /// @throws std::invalid_argument if all points are on one plane, or a coordinate is not finite,
  /// or there are more than 2^28 points.
  explicit Polytope(std::span<const Vec3> points);

  std::span<const Vec3> vertices() const { return vertices_; }
  std::span<const Face> faces() const { return faces_; }
  /// The vertices that share an edge with vertex i.
  std::span<const std::uint32_t> neighbours(std::size_t i) const {
    return std::span(neighbours_).subspan(start_[i], start_[i + 1] - start_[i]);
  }
  /// The index of vertex i among the points of the constructor.
  std::size_t source(std::size_t i) const { return source_[i]; }

  /// The mean of the vertices: a point inside, up to rounding.
  const Vec3& center() const { return center_; }
  /// The largest squared distance of a vertex from the origin, rounded.
  double reachSquared() const { return reachSquared_; }

  /// Returns a vertex that is farthest along a direction, by hill climbing: goes from a vertex to a
  /// neighbour as long as a neighbour is farther (S. Cameron, Enhancing GJK, 1997). The result is
  /// exact, in real arithmetic on the given doubles. It does not depend on the start, because a
  /// local maximum is the global one; a start near the answer saves most of the time. O(√n) steps
  /// on usual polytopes, O(n) at worst.
  /// @param steps  if not null, is increased by the number of steps.
  /// @pre the direction is finite.
  std::uint32_t climb(std::uint32_t start, const Vec3& direction,
                      std::size_t* steps = nullptr) const;
  /// Climbs like the other overload, but takes at most `most` steps. Returns nothing if more steps
  /// are needed.
  std::optional<std::uint32_t> climb(std::uint32_t start, const Vec3& direction, int most) const;

  /// Checks that each vertex has a face, and makes the checks of `checkConvexBoundary`. Returns
  /// what is wrong, or nothing. Exact.
  std::optional<std::string> check() const;

 private:
  /// Returns a neighbour of v that is farther along the direction; v if there is none.
  std::uint32_t higher(std::uint32_t v, const Vec3& direction) const;

  std::vector<Vec3> vertices_;
  std::vector<Face> faces_;
  std::vector<std::uint32_t> start_, neighbours_;
  std::vector<std::size_t> source_;
  Vec3 center_ = Vec3::Zero();
  double reachSquared_ = 0;
};

/// Returns for each face of a closed boundary the three faces beyond its edges. Entry k belongs to
/// the edge from corner k to corner k + 1. O(n), by counting sort.
/// @param vertices  one more than the largest index of a vertex.
std::vector<Polytope::Face> facesAcross(std::span<const Polytope::Face> faces,
                                        std::size_t vertices);

/// Checks that faces are the boundary of a convex polytope: that the boundary is closed and has the
/// Euler characteristic of a sphere, that it is convex at each edge and at each vertex (and
/// therefore as a whole), that each vertex of a face is an extreme point, and that no face is
/// degenerate. Points that no face uses are ignored. Returns what is wrong, or nothing. Exact.
std::optional<std::string> checkConvexBoundary(std::span<const Vec3> points,
                                               std::span<const Polytope::Face> faces);

}  // namespace corridor
