#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "collision/convex/convex_polygon.h"

namespace corridor {

/// The points of a polygon in the order of a sweep from left to right, and the order of its edges
/// along the sweep line. Points of equal x are ordered by increasing y. This is the order of x + εy
/// for a sufficiently small ε > 0. So the sweep reaches no two points at once, and no edge is
/// parallel to the sweep line.
///
/// Edge i goes from point i to point i + 1.
class PolygonSweep {
 public:
  explicit PolygonSweep(std::span<const Vec2> points)
      : points_(points.begin(), points.end()), order_(points.size()), rank_(points.size()) {
    // Under flush-to-zero, subnormal coordinates count as 0, in comparisons as in predicates.
    for (Vec2& p : points_) p += Vec2::Zero();
    std::iota(order_.begin(), order_.end(), 0u);
    std::sort(order_.begin(), order_.end(), [this](std::uint32_t i, std::uint32_t j) {
      const Vec2 &p = points_[i], &q = points_[j];
      return p.x() < q.x() || (p.x() == q.x() && (p.y() < q.y() || (p.y() == q.y() && i < j)));
    });
    for (std::uint32_t k = 0; k < order_.size(); ++k) rank_[order_[k]] = k;
  }

  std::size_t size() const { return points_.size(); }
  const Vec2& point(std::uint32_t i) const { return points_[i]; }
  std::span<const std::uint32_t> order() const { return order_; }
  bool isBefore(std::uint32_t i, std::uint32_t j) const { return rank_[i] < rank_[j]; }
  std::uint32_t next(std::uint32_t i) const { return i + 1 < size() ? i + 1 : 0; }
  std::uint32_t previous(std::uint32_t i) const {
    return (i > 0 ? i : static_cast<std::uint32_t>(size())) - 1;
  }
  std::uint32_t left(std::uint32_t edge) const {
    return isBefore(edge, next(edge)) ? edge : next(edge);
  }
  std::uint32_t right(std::uint32_t edge) const {
    return isBefore(edge, next(edge)) ? next(edge) : edge;
  }
  /// Returns the side of the line from point i to point j on which point k is, as `lineSide` does.
  int side(std::uint32_t i, std::uint32_t j, std::uint32_t k) const {
    return lineSide(points_[i], points_[j], points_[k]);
  }
  /// Returns 1 if point k is above the line of the edge, −1 if it is below, 0 if it is on the line.
  int above(std::uint32_t edge, std::uint32_t k) const { return side(left(edge), right(edge), k); }

  /// The order, from below to above, of edges that one sweep line meets. Two edges are compared at
  /// the left end that the sweep reaches later. If this point is on both edges, the right end of
  /// the later edge decides.
  struct Below {
    using is_transparent = void;
    const PolygonSweep* sweep;

    bool operator()(std::uint32_t a, std::uint32_t b) const {
      if (a == b) return false;
      const bool aFirst = !sweep->isBefore(sweep->left(b), sweep->left(a));
      const std::uint32_t longer = aFirst ? a : b, other = aFirst ? b : a;
      int side = sweep->above(longer, sweep->left(other));
      if (side == 0) side = sweep->above(longer, sweep->right(other));
      return aFirst ? side > 0 : side < 0;
    }
    struct Point {
      std::uint32_t index;
    };
    bool operator()(std::uint32_t edge, Point point) const {
      return sweep->above(edge, point.index) > 0;
    }
    bool operator()(Point point, std::uint32_t edge) const {
      return sweep->above(edge, point.index) < 0;
    }
  };

 private:
  std::vector<Vec2> points_;
  std::vector<std::uint32_t> order_, rank_;
};

}  // namespace corridor
