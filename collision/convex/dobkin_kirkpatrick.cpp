#include "collision/convex/dobkin_kirkpatrick.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <Eigen/Geometry>

#include "collision/convex/rational-inl.h"
#include "collision/core/rounding.h"
#include "collision/predicates/along.h"
#include "collision/predicates/orientation.h"

namespace corridor {
namespace {

using seidel::Rational;
using seidel::rational;

}  // namespace

/// An edge of the shadow at the topmost vertex: its other end, and the two faces at the edge.
struct DobkinKirkpatrick::Edge {
  std::uint32_t to = kNone;
  std::array<std::uint32_t, 2> faces{};
};

/// The shadow of a polytope on a plane: (e·x, d·x) for two independent directions.
struct DobkinKirkpatrick::Shadow {
  Shadow(const DobkinKirkpatrick& hierarchy, const Vec3& up, const Vec3& across)
      : of(hierarchy), d(up), e(across) {}

  const DobkinKirkpatrick& of;
  Vec3 d, e;
  std::uint32_t top = 0;
  Edge left, right;
  Cost cost;

  struct Point {
    double across, along;
  };

  const Vec3& at(std::uint32_t v) const { return of.polytope_.vertices()[v]; }
  Point projected(std::uint32_t v) {
    cost.products += 2;
    const Vec3 x = at(v) - at(top);
    return {e.dot(x), d.dot(x)};
  }
  /// Above 0 if q is counterclockwise from p, both as seen from the topmost vertex.
  static double turn(const Point& p, const Point& q) {
    return p.across * q.along - p.along * q.across;
  }

  void begin() {
    for (const std::uint32_t v : of.simplex_) {
      cost.products += 2;
      if (v == of.simplex_[0] || d.dot(at(v)) > d.dot(at(top))) top = v;
    }
    std::array<std::uint32_t, 3> others{};
    std::size_t count = 0;
    for (const std::uint32_t v : of.simplex_)
      if (v != top) others[count++] = v;
    // The edge to a vertex is at the two faces that are opposite to the two other vertices.
    chooseEdges(others, [&](std::size_t i) {
      std::array<std::uint32_t, 2> faces{};
      std::size_t to = 0;
      for (std::size_t k = 0; k < 4; ++k)
        if (of.simplex_[k] != top && of.simplex_[k] != others[i]) faces[to++] = of.simplexFaces_[k];
      return faces;
    });
  }

  /// Sets the two edges of the shadow to the outermost of these neighbours of the topmost vertex.
  template <class FacesOf>
  void chooseEdges(std::span<const std::uint32_t> neighbours, const FacesOf& facesOf) {
    std::size_t leftmost = 0, rightmost = 0;
    Point l = projected(neighbours[0]), r = l;
    for (std::size_t i = 1; i < neighbours.size(); ++i) {
      const Point p = projected(neighbours[i]);
      // All neighbours are below the topmost vertex, so the angles span at most a half turn. The
      // one on the left has the least angle.
      if (turn(p, l) > 0) l = p, leftmost = i;
      if (turn(r, p) > 0) r = p, rightmost = i;
    }
    left = {neighbours[leftmost], facesOf(leftmost)};
    right = {neighbours[rightmost], facesOf(rightmost)};
  }

  /// Goes from P_level to P_{level−1}.
  void refine(std::size_t level) {
    std::array<std::uint32_t, 4> added{};
    std::size_t count = 0;
    for (const Edge* edge : {&left, &right})
      for (const std::uint32_t f : edge->faces) {
        const Face& face = of.faces_[f];
        if (face.born != level) continue;
        if (std::find(added.begin(), added.begin() + count, face.opposite) == added.begin() + count)
          added[count++] = face.opposite;
      }
    if (count == 0) return;
    double highest = 0;
    std::uint32_t best = kNone;
    for (std::size_t i = 0; i < count; ++i) {
      ++cost.products;
      const double along = d.dot(at(added[i]) - at(top));
      if (along > highest) highest = along, best = added[i];
    }
    if (best == kNone) {
      refineEdge(left, level, true);
      refineEdge(right, level, false);
      return;
    }
    top = best;
    const auto ring = of.ringOf(top), star = of.starOf(top);
    chooseEdges(ring, [&](std::size_t j) {
      return std::array{star[(j + star.size() - 1) % star.size()], star[j]};
    });
  }

  /// Replaces an edge of the shadow, at the same vertex, by the one in the finer polytope.
  void refineEdge(Edge& edge, std::size_t level, bool isLeft) {
    const Edge old = edge;
    bool kept = true, changed = false;
    std::array<std::uint32_t, 2> faces = old.faces;
    for (std::uint32_t& f : faces) {
      if (of.faces_[f].born != level) continue;
      changed = true;
      const std::uint32_t u = of.faces_[f].opposite;
      const auto ring = of.ringOf(u), star = of.starOf(u);
      const std::size_t n = ring.size();
      const std::size_t j = std::find(ring.begin(), ring.end(), top) - ring.begin();
      if (ring[(j + 1) % n] == old.to)
        f = star[j];
      else if (ring[(j + n - 1) % n] == old.to)
        f = star[(j + n - 1) % n];
      else
        kept = false;  // a diagonal of the hole
    }
    if (!changed) return;
    Point best{};
    bool found = kept;
    if (kept) edge.faces = faces, best = projected(old.to);
    for (const std::uint32_t f : old.faces) {
      if (of.faces_[f].born != level) continue;
      const std::uint32_t u = of.faces_[f].opposite;
      const Point p = projected(u);
      if (found && !((isLeft ? turn(p, best) : turn(best, p)) > 0)) continue;
      const auto ring = of.ringOf(u), star = of.starOf(u);
      const std::size_t j = std::find(ring.begin(), ring.end(), top) - ring.begin();
      edge = {u, {star[(j + star.size() - 1) % star.size()], star[j]}};
      best = p;
      found = true;
    }
  }

  /// Returns the sign of `turn` for two vertices, exactly.
  int exactTurn(std::uint32_t p, std::uint32_t q) const {
    // Each coordinate is off by at most 4u of its terms' magnitudes (`alongSign`), so a product by
    // 9u of the product of those, and the difference by 10u of both. 2^-900 covers underflow of
    // values below 2^50.
    const Vec3 x = at(p) - at(top), y = at(q) - at(top);
    const auto size = [](const Vec3& n, const Vec3& v) { return n.cwiseAbs().dot(v.cwiseAbs()); };
    const double value = e.dot(x) * d.dot(y) - d.dot(x) * e.dot(y);
    const double scale = size(e, x) * size(d, y) + size(d, x) * size(e, y);
    if (std::abs(value) > 16 * kUnit * scale + 0x1p-900 && scale < 0x1p100 &&
        std::max({d.cwiseAbs().maxCoeff(), x.cwiseAbs().maxCoeff(), y.cwiseAbs().maxCoeff()}) <
            0x1p50)
      return value > 0 ? 1 : -1;
    std::array<Rational, 4> c;
    for (int k = 0; k < 3; ++k) {
      const Rational origin = rational(at(top)[k]);
      const Rational px = rational(at(p)[k]) - origin, qx = rational(at(q)[k]) - origin;
      c[0] += rational(e[k]) * px;
      c[1] += rational(d[k]) * px;
      c[2] += rational(e[k]) * qx;
      c[3] += rational(d[k]) * qx;
    }
    return Rational(c[0] * c[3] - c[1] * c[2]).sign();
  }

  /// Proves that the topmost vertex is topmost: its two edges are not above it, and each is on the
  /// boundary of the shadow, because the two faces at the edge are on one side of it. (The line
  /// through such an edge supports the polytope locally, and so as a whole.) The shadow is then
  /// between the two edges.
  bool proved() const {
    const int upLeft = alongSign(d, at(top), at(left.to)),
              upRight = alongSign(d, at(top), at(right.to));
    if (upLeft > 0 || upRight > 0) return false;
    const auto beside = [&](const Edge& edge, int side) {
      for (const std::uint32_t f : edge.faces)
        for (const std::uint32_t v : of.faces_[f].corner)
          if (v != top && v != edge.to && exactTurn(edge.to, v) * side < 0) return false;
      return true;
    };
    const bool halfTurn = upLeft == 0 && upRight == 0 && alongSign(e, at(top), at(left.to)) < 0 &&
                          alongSign(e, at(top), at(right.to)) > 0;
    return (halfTurn || exactTurn(left.to, right.to) > 0) && beside(left, 1) && beside(right, -1);
  }
};

std::uint32_t DobkinKirkpatrick::extreme(const Vec3& direction, Cost* cost) const {
  const double largest = direction.cwiseAbs().maxCoeff();
  // Tiny components may count as 0 in comparisons and products, but not in exact predicates.
  if (!(largest > 0x1p-1000)) {
    if (cost) *cost = {};
    return polytope_.climb(simplex_[0], direction, cost ? &cost->climbs : nullptr);
  }
  // Scaling by a power of two is exact, unless a component vanishes beside the largest one.
  const double unit = powerOfTwo(largest);
  const Vec3 d = direction / unit;
  // Any second direction will do. An edge whose shadow is a point would be of no use, and this is
  // the less likely the less the direction has to do with the axes.
  const Vec3 u = d.unitOrthogonal();
  Shadow shadow(*this, d, 0.7548776662466927 * u + 0.5698402909980532 * d.cross(u));
  shadow.begin();
  for (std::size_t level = levels() - 1; level > 0; --level) shadow.refine(level);
  std::uint32_t v = shadow.top;
  // Compared by their bits: under denormals-are-zero, a subnormal component would count as 0.
  const Vec3 scaledBack = d * unit;
  const bool sameDirection =
      std::memcmp(scaledBack.data(), direction.data(), 3 * sizeof(double)) == 0;
  if (!sameDirection || !shadow.proved()) v = polytope_.climb(v, direction, &shadow.cost.climbs);
  if (cost) *cost = shadow.cost;
  return v;
}

std::size_t DobkinKirkpatrick::bytes() const {
  return faces_.size() * sizeof(Face) + rings_.size() * sizeof(Ring) +
         (ringVertex_.size() + ringFace_.size()) * sizeof(std::uint32_t) +
         vertexCounts_.size() * sizeof(std::size_t);
}

std::optional<std::string> DobkinKirkpatrick::check() const {
  const std::span<const Vec3> points = polytope_.vertices();
  // The faces of each level: those born by then, and not yet removed with one of their vertices.
  const auto lastLevel = [&](const Face& face) {
    std::size_t last = levels();
    for (const std::uint32_t v : face.corner)
      if (rings_[v].removed > 0) last = std::min<std::size_t>(last, rings_[v].removed - 1);
    return last;
  };
  for (std::size_t level = 0; level < levels(); ++level) {
    const std::string where = "level " + std::to_string(level) + ": ";
    std::vector<Polytope::Face> alive;
    for (const Face& face : faces_) {
      if (face.born > level || lastLevel(face) < level) continue;
      alive.push_back(face.corner);
      if (face.born != level || level == 0) continue;
      const auto ring = ringOf(face.opposite);
      if (rings_[face.opposite].removed != level) return where + "a face has no opposite vertex";
      for (const std::uint32_t v : face.corner)
        if (std::find(ring.begin(), ring.end(), v) == ring.end())
          return where + "a face has a vertex that is no neighbour of its opposite vertex";
      if (planeSide(points[face.corner[0]], points[face.corner[1]], points[face.corner[2]],
                    points[face.opposite]) < 0)
        return where + "an opposite vertex is below its face";
    }
    if (alive.size() + 4 != 2 * vertexCounts_[level]) return where + "faces are missing";
    if (const auto wrong = checkConvexBoundary(points, alive)) return where + *wrong;
    if (level == 0) continue;
    std::size_t removed = 0;
    for (std::uint32_t v = 0; v < points.size(); ++v) {
      if (rings_[v].removed != level) continue;
      ++removed;
      if (rings_[v].size > kMostNeighbours) return where + "a removed vertex has many neighbours";
      for (const std::uint32_t w : ringOf(v))
        if (rings_[w].removed == level) return where + "two removed vertices are neighbours";
    }
    const std::size_t before = vertexCounts_[level - 1];
    if (vertexCounts_[level] + removed != before) return where + "vertices are missing";
    if (removed < std::max<std::size_t>(1, before / 20)) return where + "few vertices are removed";
  }
  return vertexCounts_.back() == 4 ? std::nullopt : std::optional<std::string>("no simplex");
}

}  // namespace corridor
