#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "collision/convex/dobkin_kirkpatrick.h"

namespace corridor {

/// The walk down a hierarchy with the farthest vertex along a direction: the *hierarchy of
/// projections* of Dobkin and Kirkpatrick (1990), one dimension less than the polytope.
///
/// The shadow of P_i on a plane that contains the direction is a polygon: the points (e·x, d·x),
/// with e any second direction. The walk keeps the topmost vertex v of this polygon and its two
/// edges at v. A vertex of P_{i−1} that is higher than v, or beyond one of these edges, is opposite
/// to one of the four faces at these edges. So a level takes constant time (J. O'Rourke,
/// Computational Geometry in C, section 7.10). All of this is done in double; `isProved` then
/// proves in exact arithmetic that v is topmost.
class PolytopeShadow {
 public:
  using Cost = DobkinKirkpatrick::Cost;

  /// Begins at the simplex. The hierarchy must outlive the walk.
  /// @pre d is finite, and its largest component is within 2^±400.
  PolytopeShadow(const DobkinKirkpatrick& hierarchy, const Vec3& d);
  /// Begins at a vertex, in the last (coarsest) polytope that has it. @pre it is not in the
  /// simplex, and is the farthest along d there.
  PolytopeShadow(const DobkinKirkpatrick& hierarchy, const Vec3& d, std::uint32_t vertex);

  std::size_t level() const { return level_; }
  std::uint32_t top() const { return top_; }
  const Cost& cost() const { return cost_; }

  /// Goes from P_i to P_{i−1}. Returns whether the topmost vertex is another one. @pre level() > 0.
  bool refine();

  /// Reports whether it is proved that the topmost vertex is topmost: its two edges are not above
  /// it, and each is on the boundary of the shadow, because the two faces at the edge are on one
  /// side of it. (The line through such an edge supports the polytope locally, and so as a whole.)
  /// The shadow is then between the two edges.
  bool isProved() const;

 private:
  static constexpr std::uint32_t kNone = DobkinKirkpatrick::kNone;

  /// An edge of the shadow at the topmost vertex: its other end, and the two faces at the edge.
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
  /// Above 0 if q is counterclockwise from p, both as seen from the topmost vertex.
  static double turn(const Point& p, const Point& q) {
    return p.across * q.along - p.along * q.across;
  }
  /// Returns the sign of `turn` for two vertices, exactly.
  int exactTurn(std::uint32_t p, std::uint32_t q) const;

  /// Sets the two edges to the outermost of these neighbours of the topmost vertex.
  template <class FacesOf>
  void chooseEdges(std::span<const std::uint32_t> neighbours, const FacesOf& facesOf);
  /// Makes a removed vertex the topmost one, at the last level that has it.
  void takeTop(std::uint32_t v);
  /// Replaces an edge of the shadow, at the same vertex, by the one in the finer polytope.
  void refineEdge(Edge& edge, bool isLeft);

  const DobkinKirkpatrick& of_;
  Vec3 d_, e_;
  std::size_t level_;
  std::uint32_t top_ = 0;
  Edge left_, right_;
  Cost cost_;
};

}  // namespace corridor
