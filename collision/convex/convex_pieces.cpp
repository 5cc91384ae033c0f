#include <algorithm>
#include <array>
#include <iterator>
#include <set>
#include <utility>

#include "collision/convex/polygon_sweep.h"
#include "collision/convex/simple_polygon.h"

namespace corridor {
namespace {

using Diagonal = std::array<std::uint32_t, 2>;
using Index = std::uint32_t;

/// Returns diagonals that cut a counterclockwise simple polygon into monotone polygons. (Every
/// vertical line crosses the boundary of a monotone polygon at most twice.) `status` has those
/// edges on the sweep line that go to the right; the inside of the polygon is above them. Some of
/// the vertices reached so far see such an edge straight below them. The `helper` of the edge is
/// the latest of these vertices.
std::vector<Diagonal> monotoneDiagonals(const PolygonSweep& sweep) {
  std::set<Index, PolygonSweep::Below> status{PolygonSweep::Below{&sweep}};
  std::vector<Index> helper(sweep.size());
  std::vector<char> isMerge(sweep.size());
  std::vector<Diagonal> diagonals;
  const auto joinMerge = [&](Index v, Index edge) {
    if (isMerge[helper[edge]]) diagonals.push_back({v, helper[edge]});
  };
  const auto begin = [&](Index edge, Index v) {
    status.insert(edge);
    helper[edge] = v;
  };
  const auto end = [&](Index edge, Index v) {
    joinMerge(v, edge);
    status.erase(edge);
  };
  const auto edgeBelow = [&](Index v) {
    return *std::prev(status.lower_bound(PolygonSweep::Below::Point{v}));
  };
  for (const Index v : sweep.order()) {
    const Index p = sweep.previous(v), n = sweep.next(v);
    const bool enters = sweep.isBefore(p, v), leaves = sweep.isBefore(v, n);
    if (enters && leaves) {  // the inside is above
      end(p, v);
      begin(v, v);
    } else if (!enters && !leaves) {  // the inside is below
      const Index edge = edgeBelow(v);
      joinMerge(v, edge);
      helper[edge] = v;
    } else if (const bool convex = sweep.side(p, v, n) > 0; leaves) {  // both edges begin
      if (!convex) {
        const Index edge = edgeBelow(v);
        diagonals.push_back({v, helper[edge]});
        helper[edge] = v;
      }
      begin(v, v);
    } else {  // both edges end
      end(p, v);
      if (convex) continue;
      const Index edge = edgeBelow(v);
      joinMerge(v, edge);
      helper[edge] = v;
      isMerge[v] = true;
    }
  }
  return diagonals;
}

/// A counterclockwise polygon cut along diagonals. Half-edge i < n goes from vertex i along the
/// boundary. Half-edges n + 2d and n + 2d + 1 are the two directions of diagonal d. A face is to
/// the left of its half-edges.
class Subdivision {
 public:
  Subdivision(const PolygonSweep& sweep, std::span<const Diagonal> diagonals)
      : sweep_(sweep), count_(static_cast<Index>(sweep.size())) {
    std::vector<std::vector<Index>> outgoing(count_);
    for (Index i = 0; i < count_; ++i) origin_.push_back(i);
    for (const auto& [a, b] : diagonals)
      for (const Index v : {a, b}) {
        outgoing[v].push_back(static_cast<Index>(origin_.size()));
        origin_.push_back(v);
      }
    next_.resize(origin_.size());
    previous_.resize(origin_.size());
    alive_.assign(origin_.size(), 1);
    for (Index v = 0; v < count_; ++v) {
      std::vector<Index>& around = outgoing[v];
      sortAround(v, around);
      // Goes counterclockwise, from the edge to the next vertex. `before` is the previous outgoing
      // half-edge.
      Index before = v;
      for (const Index h : around) {
        link(twin(h), before);
        before = h;
      }
      link(sweep.previous(v), before);
    }
  }

  /// Removes each diagonal that is not needed. A diagonal is not needed if the corners at both of
  /// its ends are still convex after its removal.
  void removeNeedless() {
    for (Index h = count_; h < origin_.size(); h += 2)
      if (isConvexWithout(h) && isConvexWithout(twin(h))) {
        const Index t = twin(h);
        link(previous_[h], next_[t]);
        link(previous_[t], next_[h]);
        alive_[h] = alive_[t] = 0;
      }
  }

  /// Returns the vertices of each face, counterclockwise.
  std::vector<std::vector<Index>> faces() const {
    std::vector<std::vector<Index>> faces;
    std::vector<char> seen(origin_.size());
    for (Index h = 0; h < origin_.size(); ++h) {
      if (!alive_[h] || seen[h]) continue;
      std::vector<Index>& face = faces.emplace_back();
      for (Index k = h; !seen[k]; k = next_[k]) {
        seen[k] = 1;
        face.push_back(origin_[k]);
      }
    }
    return faces;
  }

 private:
  Index twin(Index h) const { return ((h - count_) ^ 1) + count_; }
  Index target(Index h) const { return h < count_ ? sweep_.next(h) : origin_[twin(h)]; }
  void link(Index h, Index next) {
    next_[h] = next;
    previous_[next] = h;
  }
  /// Sorts diagonals from v counterclockwise, beginning at the edge from v to the next vertex.
  void sortAround(Index v, std::vector<Index>& diagonals) const {
    if (diagonals.size() < 2) return;
    const auto half = [&](Index w) {  // 0, 1, 2: the turn to w is below, at, above 180°
      return 1 - sweep_.side(v, sweep_.next(v), w);
    };
    std::sort(diagonals.begin(), diagonals.end(), [&](Index g, Index h) {
      const Index a = target(g), b = target(h);
      const int halfA = half(a), halfB = half(b);
      return halfA != halfB ? halfA < halfB : sweep_.side(v, a, b) > 0;
    });
  }
  /// Returns whether the corner at the origin of h stays convex if h is removed. @pre the angles on
  /// both sides of h are at most half a turn each.
  bool isConvexWithout(Index h) const {
    const Index v = origin_[h];
    return sweep_.side(origin_[previous_[h]], v, target(next_[twin(h)])) >= 0;
  }

  const PolygonSweep& sweep_;
  Index count_;
  std::vector<Index> origin_, next_, previous_;
  std::vector<char> alive_;
};

/// Appends diagonals that cut a monotone polygon into triangles. None of these triangles is flat.
/// `face` has the vertices of the polygon, counterclockwise.
void triangulate(const PolygonSweep& sweep, const std::vector<Index>& face,
                 std::vector<Diagonal>& diagonals) {
  const std::size_t n = face.size();
  if (n == 3) return;
  struct Vertex {
    Index index;
    bool lower;
  };
  // The lower chain goes forward from the leftmost vertex, the upper one backward.
  const auto before = [&](Index a, Index b) { return sweep.isBefore(a, b); };
  std::size_t low = std::min_element(face.begin(), face.end(), before) - face.begin();
  std::size_t high = (low + n - 1) % n;
  std::vector<Vertex> sorted{{face[low], true}};
  low = (low + 1) % n;
  while (sorted.size() < n) {
    const bool lower = low == high || sweep.isBefore(face[low], face[high]);
    sorted.push_back({face[lower ? low : high], lower});
    if (lower)
      low = (low + 1) % n;
    else
      high = (high + n - 1) % n;
  }
  // The vertices that are not yet cut off. They form a chain without convex corners.
  std::vector<Vertex> stack{sorted[0], sorted[1]};
  for (std::size_t j = 2; j + 1 < n; ++j) {
    const Vertex v = sorted[j];
    Vertex last = stack.back();
    if (v.lower != last.lower) {
      for (std::size_t k = 1; k < stack.size(); ++k) diagonals.push_back({v.index, stack[k].index});
      stack = {last, v};
      continue;
    }
    stack.pop_back();
    while (!stack.empty() &&
           sweep.side(stack.back().index, last.index, v.index) * (v.lower ? 1 : -1) > 0) {
      last = stack.back();
      stack.pop_back();
      diagonals.push_back({v.index, last.index});
    }
    stack.push_back(last);
    stack.push_back(v);
  }
  for (std::size_t k = 1; k + 1 < stack.size(); ++k)
    diagonals.push_back({sorted.back().index, stack[k].index});
}

}  // namespace

std::vector<std::vector<std::uint32_t>> convexPieces(std::span<const Vec2> points) {
  // The leftmost corner is convex, so the direction of its turn shows the orientation of the
  // polygon.
  std::vector<Vec2> corners(points.begin(), points.end());
  const auto n = static_cast<Index>(corners.size());
  PolygonSweep sweep(corners);
  const Index first = sweep.order()[0];
  const bool clockwise = sweep.side(sweep.previous(first), first, sweep.next(first)) < 0;
  if (clockwise) {
    std::reverse(corners.begin(), corners.end());
    sweep = PolygonSweep(corners);
  }
  std::vector<Diagonal> diagonals = monotoneDiagonals(sweep);
  for (const std::vector<Index>& face : Subdivision(sweep, diagonals).faces())
    triangulate(sweep, face, diagonals);
  Subdivision pieces(sweep, diagonals);
  pieces.removeNeedless();
  std::vector<std::vector<Index>> result = pieces.faces();
  for (std::vector<Index>& piece : result) {
    std::vector<Index> strict;
    for (std::size_t k = 0; k < piece.size(); ++k) {
      const Index before = piece[(k + piece.size() - 1) % piece.size()];
      if (sweep.side(before, piece[k], piece[(k + 1) % piece.size()]) != 0)
        strict.push_back(clockwise ? n - 1 - piece[k] : piece[k]);
    }
    piece = std::move(strict);
  }
  return result;
}

}  // namespace corridor
