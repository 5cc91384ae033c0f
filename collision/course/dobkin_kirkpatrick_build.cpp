#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "collision/course/dobkin_kirkpatrick.h"
#include "collision/predicates/orientation.h"

namespace corridor {

/// Removes vertices from a triangulated convex surface, level after level.
class DobkinKirkpatrickBuilder {
 public:
  explicit DobkinKirkpatrickBuilder(DobkinKirkpatrick& result)
      : to_(result), points_(result.polytope_.vertices()) {
    const std::size_t n = points_.size();
    to_.rings_.resize(n);
    to_.faces_.reserve(6 * n);
    anyFace_.resize(n);
    degree_.assign(n, 0);
    blockedAt_.assign(n, 0);
    for (const Polytope::Face& face : to_.polytope_.faces()) newFace(face, kNone, 0);
    across_ = facesAcross(to_.polytope_.faces(), n);
    for (const Polytope::Face& face : to_.polytope_.faces())
      for (const std::uint32_t v : face) ++degree_[v];
    alive_.resize(n);
    for (std::uint32_t v = 0; v < n; ++v) alive_[v] = v;
    to_.vertexCounts_.push_back(n);
    while (alive_.size() > 4) removeSet();
    takeSimplex();
  }

 private:
  static constexpr std::uint32_t kNone = DobkinKirkpatrick::kNone;
  std::uint32_t newFace(const Polytope::Face& corner, std::uint32_t opposite, std::size_t level) {
    const auto f = static_cast<std::uint32_t>(to_.faces_.size());
    to_.faces_.push_back({corner, opposite, static_cast<std::uint16_t>(level)});
    across_.push_back({kNone, kNone, kNone});
    for (const std::uint32_t v : corner) anyFace_[v] = f;
    return f;
  }

  int cornerOf(std::uint32_t f, std::uint32_t v) const {
    const Polytope::Face& corner = to_.faces_[f].corner;
    return corner[0] == v ? 0 : corner[1] == v ? 1 : 2;
  }

  /// Removes vertices that have at most `kMostNeighbours` neighbours each, and of which no two are
  /// neighbours. Vertices of low degree are removed first.
  void removeSet() {
    const std::size_t level = to_.vertexCounts_.size();
    if (level >= std::numeric_limits<std::uint16_t>::max())
      throw std::logic_error("the hierarchy of a polytope has too many levels");
    std::size_t left = alive_.size();
    // A removal changes only the degrees of vertices that it blocks.
    for (int degree = 3; degree <= DobkinKirkpatrick::kMostNeighbours; ++degree)
      for (const std::uint32_t v : alive_) {
        if (blockedAt_[v] == level || to_.rings_[v].removed || degree_[v] != degree || left == 4)
          continue;
        if (!remove(v, level, left)) continue;
        --left;
        for (const std::uint32_t w : ring_) blockedAt_[w] = level;
      }
    std::erase_if(alive_, [&](std::uint32_t v) { return to_.rings_[v].removed > 0; });
    to_.vertexCounts_.push_back(alive_.size());
  }

  /// Removes a vertex, fills the hole by the hull of its neighbours, and returns true. If the
  /// remaining polytope would be flat, because the vertex is the apex of a pyramid, changes nothing
  /// and returns false.
  bool remove(std::uint32_t v, std::size_t level, std::size_t left) {
    ring_.clear();
    star_.clear();
    outer_.clear();
    for (std::uint32_t f = anyFace_[v], first = f;;) {
      const int k = cornerOf(f, v);
      ring_.push_back(to_.faces_[f].corner[(k + 1) % 3]);
      star_.push_back(f);
      outer_.push_back(across_[f][(k + 1) % 3]);
      f = across_[f][(k + 2) % 3];
      if (f == first) break;
    }
    // The loop above goes counterclockwise: from face (v, a, b) to the face across the edge from b
    // to v.
    if (left == ring_.size() + 1 && ringIsFlat()) return false;
    DobkinKirkpatrick::Ring& ring = to_.rings_[v];
    ring = {static_cast<std::uint32_t>(to_.ringVertex_.size()),
            static_cast<std::uint16_t>(ring_.size()), static_cast<std::uint16_t>(level)};
    to_.ringVertex_.insert(to_.ringVertex_.end(), ring_.begin(), ring_.end());
    to_.ringFace_.insert(to_.ringFace_.end(), star_.begin(), star_.end());
    fill(v, level);
    return true;
  }

  bool ringIsFlat() const {
    for (std::size_t i = 3; i < ring_.size(); ++i)
      if (planeSide(points_[ring_[0]], points_[ring_[1]], points_[ring_[2]], points_[ring_[i]]) !=
          0)
        return false;
    return true;
  }

  /// The removal of v leaves a hole. Fills the hole with those faces of the hull of v's neighbours
  /// that are visible from v. The boundary of these faces is the ring, because each face at v has
  /// all neighbours on or below its plane. The faces are cut off the hole one by one, as ears. An
  /// ear is a face of the hull if no neighbour of v is above the plane of the ear, and v is not
  /// below this plane.
  void fill(std::uint32_t v, std::size_t level) {
    std::vector<Side>& hole = hole_;
    hole.clear();
    for (std::size_t i = 0; i < ring_.size(); ++i) {
      hole.push_back({ring_[i], outer_[i]});
      --degree_[ring_[i]];
    }
    const auto isFace = [&](const Polytope::Face& ear) {
      const auto sign = [&](std::uint32_t p) {
        return planeSide(points_[ear[0]], points_[ear[1]], points_[ear[2]], points_[p]);
      };
      if (sign(v) < 0) return false;
      return std::all_of(ring_.begin(), ring_.end(), [&](std::uint32_t p) {
        return p == ear[0] || p == ear[1] || p == ear[2] || sign(p) <= 0;
      });
    };
    const auto link = [&](std::uint32_t f, int edge, std::uint32_t outer) {
      across_[f][edge] = outer;
      // The outer face has the edge in the opposite direction.
      const std::uint32_t from = to_.faces_[f].corner[(edge + 1) % 3];
      across_[outer][cornerOf(outer, from)] = f;
    };
    while (hole.size() > 3) {
      const std::size_t n = hole.size();
      std::size_t j = 0;
      Polytope::Face ear{};
      for (;; ++j) {
        if (j == n) throw std::logic_error("the hole of a removed vertex has no ear");
        ear = {hole[(j + n - 1) % n].vertex, hole[j].vertex, hole[(j + 1) % n].vertex};
        if (isFace(ear)) break;
      }
      const std::uint32_t f = newFace(ear, v, level);
      Side& before = hole[(j + n - 1) % n];
      link(f, 0, before.outer);
      link(f, 1, hole[j].outer);
      before.outer = f;
      ++degree_[ear[0]];
      ++degree_[ear[2]];
      hole.erase(hole.begin() + static_cast<std::ptrdiff_t>(j));
    }
    const std::uint32_t f = newFace({hole[0].vertex, hole[1].vertex, hole[2].vertex}, v, level);
    for (int k = 0; k < 3; ++k) link(f, k, hole[k].outer);
  }

  /// Keeps the last four vertices and their faces.
  void takeSimplex() {
    std::copy(alive_.begin(), alive_.end(), to_.simplex_.begin());
    for (std::size_t k = 0; k < 4; ++k) {
      const std::uint32_t v = to_.simplex_[k];
      const std::uint32_t f = anyFace_[to_.simplex_[(k + 1) % 4]];
      for (const std::uint32_t g : {f, across_[f][0], across_[f][1], across_[f][2]}) {
        const Polytope::Face& corner = to_.faces_[g].corner;
        if (std::find(corner.begin(), corner.end(), v) == corner.end()) to_.simplexFaces_[k] = g;
      }
    }
  }

  DobkinKirkpatrick& to_;
  std::span<const Vec3> points_;
  /// For each face: the faces beyond its edges from corner k to k + 1.
  std::vector<Polytope::Face> across_;
  std::vector<std::uint32_t> anyFace_;  ///< one face of each vertex
  std::vector<int> degree_;
  std::vector<std::uint32_t> alive_;
  std::vector<std::size_t> blockedAt_;  ///< the last level at which a neighbour was removed, or 0
  std::vector<std::uint32_t> ring_, star_, outer_;
  /// An edge of a hole, from `vertex` to the vertex of the next side; `outer` is the face beyond
  /// the edge.
  struct Side {
    std::uint32_t vertex, outer;
  };
  std::vector<Side> hole_;
};

DobkinKirkpatrick::DobkinKirkpatrick(Polytope polytope) : polytope_(std::move(polytope)) {
  DobkinKirkpatrickBuilder build(*this);
}

}  // namespace corridor
