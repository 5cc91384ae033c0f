#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "collision/convex/convex_polygon.h"

namespace corridor {

/// The reason why a list of points is not the boundary of a simple polygon. Edge i goes from point
/// i to point i + 1, and the last edge to point 0.
struct PolygonFault {
  enum class Kind {
    tooFewPoints,   ///< fewer than 3
    notFinite,      ///< point `first` has a coordinate that is not finite
    repeatedPoint,  ///< points `first` and `second` are equal
    noArea,         ///< all points are on one line
    edgesMeet  ///< edges `first` and `second` overlap, or share a point that is not their common
               ///< end
  };
  Kind kind;
  std::size_t first = 0, second = 0;  ///< first < second, if both are used
};

/// Returns why a list of points is not the boundary of a simple polygon, or nothing if it is such a
/// boundary. In a simple polygon, two edges share a point only if one follows the other, and then
/// they share only their common end. Points on the straight line between their neighbours are
/// legal. Exact, in real arithmetic on the given doubles. (Under flush-to-zero, subnormal
/// coordinates count as 0.) O(n log n).
///
/// Method: M. I. Shamos, D. Hoey, Geometric intersection problems (FOCS 1976).
std::optional<PolygonFault> checkSimple(std::span<const Vec2> points);

/// Cuts a simple polygon into convex polygons whose corners are vertices of the polygon: no vertex
/// is added. Returns the indices of each piece's vertices, counterclockwise. The pieces cover the
/// polygon exactly, and their interiors are disjoint. A vertex of a piece that is on the line
/// between its neighbours is left out, so each piece is strictly convex. Exact, as `checkSimple`
/// is. O(n log n).
///
/// The number of pieces is at most four times the least number that a partition without added
/// vertices can have. Method: monotone polygons (M. R. Garey, D. S. Johnson, F. P. Preparata, R. E.
/// Tarjan, Triangulating a simple polygon, 1978), their triangles, and the removal of each diagonal
/// without which all corners stay convex (S. Hertel, K. Mehlhorn, Fast triangulation of simple
/// polygons, 1983).
/// @pre `checkSimple` returns nothing for these points.
std::vector<std::vector<std::uint32_t>> convexPieces(std::span<const Vec2> points);

}  // namespace corridor
