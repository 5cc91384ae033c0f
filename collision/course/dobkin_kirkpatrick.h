#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "collision/convex/convex_set.h"
#include "collision/convex/polytope.h"

namespace corridor {

/// The hierarchy of Dobkin and Kirkpatrick of a convex polytope. P_0 is the polytope. P_i is the
/// hull of the vertices that remain after an independent set of vertices is removed from P_{i−1}.
/// Each removed vertex has at most 8 neighbours in P_{i−1}. The last polytope is a simplex. Each
/// face of P_i that is not a face of P_{i−1} belongs to one removed vertex. This vertex is called
/// *opposite* to the face. Height O(log n); building time and memory O(n).
///
/// Source: D. P. Dobkin, D. G. Kirkpatrick, A linear algorithm for determining the separation of
/// convex polyhedra, Journal of Algorithms 6 (1985), and Determining the separation of preprocessed
/// polyhedra: a unified approach, ICALP 1990.
class DobkinKirkpatrick final : public VertexSearch {
 public:
  static constexpr int kMostNeighbours = 8;

  /// Builds the hierarchy.
  explicit DobkinKirkpatrick(Polytope polytope);

  const Polytope& polytope() const { return polytope_; }
  /// The polytope as a convex set, whose farthest vertices the hierarchy finds in O(log n).
  operator ConvexSet() const { return {polytope_, *this}; }  // NOLINT: it is a convex set
  std::uint32_t farthest(const Vec3& direction) const override { return extreme(direction); }
  /// The number of polytopes, P_0 and the simplex included.
  std::size_t levels() const { return vertexCounts_.size(); }
  /// The number of vertices of P_i.
  std::size_t vertexCount(std::size_t level) const { return vertexCounts_[level]; }
  std::size_t bytes() const;
  /// The vertices of the simplex.
  std::span<const std::uint32_t> simplex() const { return simplex_; }
  /// The last (coarsest) level i whose polytope P_i has vertex v.
  std::size_t lastLevel(std::uint32_t v) const {
    return rings_[v].removed > 0 ? rings_[v].removed - 1U : levels() - 1;
  }
  /// The neighbours of vertex v in P_i with i = `lastLevel(v)`, counterclockwise: at most 8. Empty
  /// for a vertex of the simplex.
  std::span<const std::uint32_t> ringOf(std::uint32_t v) const {
    return std::span(ringVertex_).subspan(rings_[v].start, rings_[v].size);
  }

  /// The work of one query.
  struct Cost {
    std::size_t products = 0;  ///< inner products of the direction with vertices
    /// Steps of hill climbing on P_0, if rounding misled or prevented the walk.
    std::size_t climbs = 0;
  };
  /// Returns a vertex that is farthest along a direction: exact, in real arithmetic on the given
  /// doubles. O(log n).
  ///
  /// Method: the hierarchy of projections (polytope_shadow.h), in double. At the end, two edges
  /// prove in exact arithmetic that the vertex is farthest. If this proof fails because of
  /// rounding, the query climbs from that vertex along edges, with exact comparisons.
  /// @param direction  if it is 0, any vertex may be returned.
  /// @param cost  if not null, receives the work.
  /// @pre the direction is finite.
  std::uint32_t extreme(const Vec3& direction, Cost* cost = nullptr) const;

  /// Returns what is wrong with the hierarchy, or nothing. Exact. Checks at each level that:
  /// * P_i is convex;
  /// * the removed vertices are independent and have at most 8 neighbours;
  /// * the opposite vertex of each new face is on or above the plane of the face;
  /// * at least a twentieth of the vertices, and at least one vertex, is removed.
  /// Checks also that the last polytope is a simplex.
  std::optional<std::string> check() const;

 private:
  friend class DobkinKirkpatrickBuilder;
  friend class PolytopeShadow;
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  struct Face {
    Polytope::Face corner;
    std::uint32_t opposite = kNone;  ///< kNone: a face of P_0
    std::uint16_t born = 0;          ///< the first level i for which it is a face of P_i
  };
  /// The range of the entries of a vertex v in `ringVertex_` and `ringFace_`. The entries of
  /// `ringVertex_` are the neighbours of v in the last polytope that has v, counterclockwise. The
  /// entry of `ringFace_` for a neighbour is the face of v, this neighbour and the next neighbour.
  struct Ring {
    std::uint32_t start = 0;
    std::uint16_t size = 0;
    std::uint16_t removed = 0;  ///< the first level without the vertex; 0: a vertex of the simplex
  };
  std::span<const std::uint32_t> starOf(std::uint32_t v) const {
    return std::span(ringFace_).subspan(rings_[v].start, rings_[v].size);
  }

  Polytope polytope_;
  std::vector<Face> faces_;
  std::vector<Ring> rings_;  ///< of each vertex
  std::vector<std::uint32_t> ringVertex_, ringFace_;
  std::array<std::uint32_t, 4> simplex_{};       ///< the vertices of the last polytope
  std::array<std::uint32_t, 4> simplexFaces_{};  ///< face k is opposite to vertex k of `simplex_`
  std::vector<std::size_t> vertexCounts_;
};

}  // namespace corridor
