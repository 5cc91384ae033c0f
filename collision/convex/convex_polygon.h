#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "collision/predicates/orientation.h"

namespace corridor {

/// A convex polygon: the hull of its vertices, counterclockwise. Every vertex is an extreme point,
/// in real arithmetic on the stored doubles. (Under denormals-are-zero, subnormal coordinates count
/// as 0.)
class ConvexPolygon {
 public:
  /// Builds the hull of the points, exactly (A. M. Andrew's monotone chain, 1979). O(n log n).
  /// @throws std::invalid_argument if all points are on one line, or a coordinate is not finite.
  explicit ConvexPolygon(std::span<const Vec2> points);

  std::span<const Vec2> vertices() const { return vertices_; }
  std::size_t size() const { return vertices_.size(); }
  /// Returns the vertex with the index i modulo `size()`.
  const Vec2& operator[](std::size_t i) const { return vertices_[i % vertices_.size()]; }

  /// Returns the index of a vertex that is farthest along a direction; vertex 0 for a direction of
  /// 0. Exact; O(log n), by a binary search over the directions of the edges.
  /// @pre the direction is finite.
  std::size_t extreme(const Vec2& direction) const;

  /// Checks that each corner turns left, and that the boundary goes around once. Returns what is
  /// wrong, or nothing. Exact.
  std::optional<std::string> check() const;

 private:
  std::vector<Vec2> vertices_;
};

}  // namespace corridor
