#include "collision/convex/polytope.h"

#include <algorithm>
#include <stdexcept>

#include "collision/convex/quickhull.h"
#include "collision/predicates/along.h"
#include "collision/predicates/orientation.h"

namespace corridor {
namespace {

using Face = Polytope::Face;

/// The neighbours of each vertex, in the order of its faces.
struct Rings {
  std::vector<std::uint32_t> start, vertex;

  Rings(std::size_t vertices, std::span<const Face> faces) : start(vertices + 1, 0) {
    for (const Face& face : faces)
      for (const std::uint32_t v : face) ++start[v + 1];
    for (std::size_t v = 0; v < vertices; ++v) start[v + 1] += start[v];
    // `pairs` has for each face (v, a, b) of v the pair a, b.
    std::vector<std::array<std::uint32_t, 2>> pairs(start.back());
    std::vector<std::uint32_t> fill(start.begin(), start.end() - 1);
    for (const Face& face : faces)
      for (int k = 0; k < 3; ++k) pairs[fill[face[k]]++] = {face[(k + 1) % 3], face[(k + 2) % 3]};
    vertex.resize(pairs.size());
    for (std::size_t v = 0; v < vertices; ++v) {
      const std::span around = std::span(pairs).subspan(start[v], start[v + 1] - start[v]);
      if (around.empty()) continue;
      std::sort(around.begin(), around.end());
      std::uint32_t next = around[0][0];
      for (std::size_t i = 0; i < around.size(); ++i) {
        vertex[start[v] + i] = next;
        const auto found = std::lower_bound(around.begin(), around.end(), std::array{next, 0U});
        closed = closed && found != around.end() && (*found)[0] == next;
        if (!closed) return;
        next = (*found)[1];
        closed = closed && (next == around[0][0]) == (i + 1 == around.size());
      }
    }
  }

  std::span<const std::uint32_t> of(std::size_t v) const {
    return std::span(vertex).subspan(start[v], start[v + 1] - start[v]);
  }

  bool closed = true;  ///< the faces of each vertex form one cycle
};

/// Reports whether vertex v is extreme. It is extreme if its faces are in at least three planes.
bool isExtreme(std::span<const Vec3> points, const Rings& rings, std::size_t v) {
  const auto ring = rings.of(v);
  int breaks = 0;
  for (std::size_t i = 0, n = ring.size(); i < n && breaks < 3; ++i)
    breaks += planeSide(points[v], points[ring[i]], points[ring[(i + 1) % n]],
                        points[ring[(i + 2) % n]]) != 0;
  return breaks >= 3;
}

/// Returns whether the faces of vertex v go around it once, and are therefore the boundary of a
/// convex cone. Takes time linear in the number of neighbours. @pre the faces are convex at each
/// edge at v, and in at least three planes.
///
/// Let p be a neighbour at whose edge two planes meet: those of the first and the last face.
/// Suppose that no other neighbour is above either of these planes, or on both. Then all other
/// neighbours, seen along the line from p to v, are in a wedge of an angle θ < 180°, and none is at
/// its apex. Suppose that p is above no face. Then each step from a neighbour to the next one turns
/// by at most 180° in one direction. A step back within the wedge would turn by 360° − θ or more.
/// So the directions of the neighbours never go back on their way from 0 to θ. A face in one plane
/// with v and p must be in the plane of the first or the last face, and look to the same side: the
/// second and the last neighbour are strictly on opposite sides of each plane in between. So the
/// faces do not cross each other. Faces that do not cross each other and are convex at each edge
/// bound a convex cone.
bool isConvexAround(std::span<const Vec3> points, std::span<const std::uint32_t> ring,
                    std::size_t v) {
  const std::size_t n = ring.size();
  // Returns the side of neighbour k of a face. Both count from any neighbour, modulo n.
  const auto side = [&](std::size_t face, std::size_t k) {
    return planeSide(points[v], points[ring[face % n]], points[ring[(face + 1) % n]],
                     points[ring[k % n]]);
  };
  std::size_t p = 0;
  while (p < n && side(p + n - 1, p + 1) == 0) ++p;
  if (p == n) return false;
  const std::size_t last = p + n - 1;
  for (std::size_t k = p + 1; k <= last; ++k) {
    const int ofFirst = side(p, k), ofLast = side(last, k);
    if (ofFirst > 0 || ofLast > 0 || (ofFirst == 0 && ofLast == 0)) return false;
  }
  for (std::size_t face = p; face <= last; ++face) {
    const int turn = side(face, p);
    if (turn > 0) return false;
    if (turn < 0) continue;
    const int ofSecond = side(face, p + 1), ofLast = side(face, last);
    if (ofSecond > 0 || ofLast > 0 || (ofSecond == 0 && ofLast == 0)) return false;
  }
  return true;
}

}  // namespace

Polytope::Polytope(std::span<const Vec3> points) {
  if (points.size() > (std::size_t{1} << 28))
    throw std::invalid_argument("a polytope can have at most 2^28 points");
  if (!std::all_of(points.begin(), points.end(), [](const Vec3& p) { return p.allFinite(); }))
    throw std::invalid_argument("the points of a polytope must be finite");
  std::vector<Face> faces = quickhull(points);
  if (faces.empty())
    throw std::invalid_argument("the points of a polytope must not all be on one plane");
  const auto takeVertices = [&] {
    // Stores in `source_` the indices of the extreme points among the vertices of the faces.
    // Returns the number of vertices of faces that are not extreme.
    const Rings rings(points.size(), faces);
    std::size_t dropped = 0;
    source_.clear();
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (rings.of(i).empty()) continue;
      if (isExtreme(points, rings, i))
        source_.push_back(i);
      else
        ++dropped;
    }
    return dropped;
  };
  const bool again = takeVertices() > 0;
  std::vector<std::uint32_t> number(points.size(), 0);
  for (std::uint32_t i = 0; i < source_.size(); ++i) {
    vertices_.push_back(points[source_[i]]);
    number[source_[i]] = i;
  }
  if (again) {
    faces_ = quickhull(vertices_);
  } else {
    faces_ = std::move(faces);
    for (Face& face : faces_)
      for (std::uint32_t& v : face) v = number[v];
  }
  Rings rings(vertices_.size(), faces_);
  start_ = std::move(rings.start);
  neighbours_ = std::move(rings.vertex);
  // Each vertex is divided first, so that the sum does not overflow.
  for (const Vec3& v : vertices_) {
    center_ += v / static_cast<double>(vertices_.size());
    reachSquared_ = std::max(reachSquared_, v.squaredNorm());
  }
}

std::uint32_t Polytope::higher(std::uint32_t v, const Vec3& direction) const {
  for (const std::uint32_t w : neighbours(v))
    if (alongSign(direction, vertices_[v], vertices_[w]) > 0) return w;
  return v;
}

std::uint32_t Polytope::climb(std::uint32_t start, const Vec3& direction,
                              std::size_t* steps) const {
  for (std::uint32_t top = start;;) {
    const std::uint32_t next = higher(top, direction);
    if (next == top) return top;
    if (steps) ++*steps;
    top = next;
  }
}

std::optional<std::uint32_t> Polytope::climb(std::uint32_t start, const Vec3& direction,
                                             int most) const {
  for (std::uint32_t top = start;; --most) {
    const std::uint32_t next = higher(top, direction);
    if (next == top) return top;
    if (most == 0) return std::nullopt;
    top = next;
  }
}

std::optional<std::string> Polytope::check() const {
  if (2 * vertices_.size() != faces_.size() + 4) return "a vertex has no face";
  return checkConvexBoundary(vertices_, faces_);
}

std::vector<Face> facesAcross(std::span<const Face> faces, std::size_t vertices) {
  // The edges are sorted by their higher, then by their lower vertex; the second sort keeps the
  // order of the first. Then the two faces at each edge are neighbours in the order.
  struct Edge {
    std::uint32_t low, high, face, corner;
  };
  std::vector<Edge> edges, sorted;
  for (std::uint32_t f = 0; f < faces.size(); ++f)
    for (std::uint32_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(faces[f][k], faces[f][(k + 1) % 3]);
      edges.push_back({low, high, f, k});
    }
  sorted.resize(edges.size());
  for (const auto key : {&Edge::high, &Edge::low}) {
    std::vector<std::size_t> start(vertices + 1, 0);
    for (const Edge& edge : edges) ++start[edge.*key + 1];
    for (std::size_t v = 0; v < vertices; ++v) start[v + 1] += start[v];
    for (const Edge& edge : edges) sorted[start[edge.*key]++] = edge;
    edges.swap(sorted);
  }
  std::vector<Face> across(faces.size());
  for (std::size_t i = 0; i + 1 < edges.size(); i += 2) {
    across[edges[i].face][edges[i].corner] = edges[i + 1].face;
    across[edges[i + 1].face][edges[i + 1].corner] = edges[i].face;
  }
  return across;
}

std::optional<std::string> checkConvexBoundary(std::span<const Vec3> points,
                                               std::span<const Face> faces) {
  const Rings rings(points.size(), faces);
  if (!rings.closed) return "the faces of a vertex do not form one cycle";
  std::size_t used = 0;
  for (std::size_t v = 0; v < points.size(); ++v) {
    const auto ring = rings.of(v);
    if (ring.empty()) continue;
    ++used;
    if (!isExtreme(points, rings, v)) return "vertex " + std::to_string(v) + " is not extreme";
    for (std::size_t i = 0, n = ring.size(); i < n; ++i) {
      // Takes three neighbours of v that follow each other counterclockwise, and tests the edge
      // from v to the middle one.
      if (planeSide(points[v], points[ring[i]], points[ring[(i + 1) % n]],
                    points[ring[(i + 2) % n]]) > 0)
        return "an edge at vertex " + std::to_string(v) + " is not convex";
    }
    if (!isConvexAround(points, ring, v))
      return "the faces of vertex " + std::to_string(v) + " are not convex";
  }
  if (2 * used != faces.size() + 4) return "the boundary is not a sphere";
  for (const Face& face : faces) {
    const auto isOff = [&](const Vec3& p) {
      return planeSide(points[face[0]], points[face[1]], points[face[2]], p) != 0;
    };
    if (!std::any_of(points.begin(), points.end(), isOff)) return "a face is degenerate";
  }
  return std::nullopt;
}

}  // namespace corridor
