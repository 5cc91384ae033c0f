#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "collision/course/dobkin_kirkpatrick.h"

namespace corridor {

/// A walk down a hierarchy that keeps the farthest vertex along a direction d: the *hierarchy of
/// projections* of Dobkin and Kirkpatrick (1990), which has one dimension less than the polytope.
///
/// The hierarchy consists of the polytopes P_0, the given one, to the coarsest one, a simplex. The
/// shadow is the projection of P_i onto a plane that contains d: the polygon of the points
/// (e·x, d·x), with e any second direction. The walk keeps the topmost vertex v of this polygon and
/// the polygon's two edges at v. Each new vertex of P_{i−1} is above one face of P_i. Only a vertex
/// above one of the four faces at these edges can be higher than v, or beyond one of the edges. So
/// a level takes constant time (J. O'Rourke, Computational Geometry in C, section 7.10). All of
/// this is done in double; `isProved` then proves in exact arithmetic that v is topmost.
class PolytopeShadow {
 public:
  using Cost = DobkinKirkpatrick::Cost;

  /// Begins at the simplex. The hierarchy must outlive the walk.
  /// @pre d is finite, and its largest component is within 2^±400.
  PolytopeShadow(const DobkinKirkpatrick& hierarchy, const Vec3& d);
  /// Begins at a vertex, in the last (coarsest) polytope that has this vertex.
  /// @pre the vertex is not in the simplex, and is the farthest one along d in that polytope.
  PolytopeShadow(const DobkinKirkpatrick& hierarchy, const Vec3& d, std::uint32_t vertex);

  std::size_t level() const { return level_; }
  std::uint32_t top() const { return top_; }
  const Cost& cost() const { return cost_; }

  /// Goes from P_i to P_{i−1}. Returns whether the topmost vertex has changed.
  /// @pre level() > 0.
  bool refine();

  /// Reports whether an exact test proves that `top()` is a farthest vertex of the present
  /// polytope. The test has three conditions. The two edges are not above this vertex. The turn
  /// from the left to the right edge is above 0, and at most 180°. For each edge, the two faces at
  /// the edge are on one side of the edge's line. The third condition implies that each edge is on
  /// the boundary of the shadow: the line through such an edge supports the shadow locally, and so
  /// as a whole. The shadow is then between the two edges.
  bool isProved() const;

 private:
  static constexpr std::uint32_t kNone = DobkinKirkpatrick::kNone;

  /// An edge of the shadow at the topmost vertex. It is given by its other end, and by the two
  /// faces of the polytope at the edge.
  struct Edge {
    std::uint32_t to = kNone;
    std::array<std::uint32_t, 2> faces{};
  };
  struct Point {
    double across, along;
  };

  const Vec3& at(std::uint32_t v) const { return of_.polytope_.vertices()[v]; }
  Point projected(std::uint32_t v) {
    cost_.products += 2;
    const Vec3 x = at(v) - at(top_);
    return {e_.dot(x), d_.dot(x)};
  }
  /// Returns a number above 0 if q is counterclockwise from p, as seen from the topmost vertex.
  static double turn(const Point& p, const Point& q) {
    return p.across * q.along - p.along * q.across;
  }
  /// Returns the sign of `turn` for two vertices, exactly.
  int exactTurn(std::uint32_t p, std::uint32_t q) const;

  /// Sets the two edges to those that end at the leftmost and the rightmost of these neighbours of
  /// the topmost vertex.
  template <class FacesOf>
  void chooseEdges(std::span<const std::uint32_t> neighbours, const FacesOf& facesOf);
  /// Makes vertex v, which is not in the simplex, the topmost vertex. Sets its two edges to those
  /// in the last (coarsest) polytope that has v.
  void takeTop(std::uint32_t v);
  /// Replaces an edge of the shadow by the edge of the next finer polytope, at the same topmost
  /// vertex.
  void refineEdge(Edge& edge, bool isLeft);

  const DobkinKirkpatrick& of_;
  Vec3 d_, e_;
  std::size_t level_;
  std::uint32_t top_ = 0;
  Edge left_, right_;
  Cost cost_;
};

}  // namespace corridor
