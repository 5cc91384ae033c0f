#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "collision/convex/quickhull.h"
#include "collision/predicates/orientation.h"
#include "collision/volumes/hull.h"
#include "tests/support/exact_volume.h"

namespace corridor::exact {

/// Returns whether p is in the tetrahedron, by the signs of p's barycentric coordinates. Returns
/// false if the corners are on one plane.
inline bool inTetrahedron(const std::array<Row, 4>& corners, const Row& p) {
  const auto volume = [](const Row& a, const Row& b, const Row& c, const Row& d) -> Rational {
    return dot(minus(a, d), cross(minus(b, d), minus(c, d)));
  };
  const auto& [a, b, c, d] = corners;
  const Rational all = volume(a, b, c, d);
  return all != 0 && volume(p, b, c, d) * all >= 0 && volume(a, p, c, d) * all >= 0 &&
         volume(a, b, p, d) * all >= 0 && volume(a, b, c, p) * all >= 0;
}

/// Returns whether p is in the triangle, which may be degenerate: a segment or a point.
inline bool inTriangle(const Row& a, const Row& b, const Row& c, const Row& p) {
  const Row n = cross(minus(b, a), minus(c, a)), d = minus(p, a);
  if (dot(n, n) > 0)
    return dot(d, n) == 0 && dot(cross(minus(b, a), d), n) >= 0 &&
           dot(cross(minus(c, b), minus(p, b)), n) >= 0 && dot(cross(d, minus(c, a)), n) >= 0;
  const auto inSegment = [&](const Row& from, const Row& to) {
    const Row edge = minus(to, from), along = minus(p, from), off = cross(edge, along);
    return dot(off, off) == 0 && dot(along, edge) >= 0 && dot(along, along) <= dot(edge, edge);
  };
  return inSegment(a, b) || inSegment(b, c) || inSegment(c, a);
}

/// Proves that the centre of a sphere is in the hull of the vertices, and that the sphere's radius
/// is at most the hull's `size`. The proof works only for a centre whose coordinates are doubles.
/// It shows that the centre is a vertex, or is in a simplex of vertices. By Carathéodory's theorem,
/// each point of the hull is in a simplex that has the first vertex as a corner. The simplices that
/// are tried join the first vertex to each face of the hull. If all vertices are on one plane, the
/// simplices that are tried join the first vertex to each pair of vertices.
template <>
class ExactVolume<Hull> {
 public:
  explicit ExactVolume(const Hull& hull) : vertices_(hull.vertices), size_(hull.size) {
    std::sort(vertices_.begin(), vertices_.end(), isBefore);
    faces_ = quickhull(vertices_);
  }

  bool contains(const Row& p, const Rational& radius) const {
    if (radius > size_) return false;
    const Vec3 q(p[0].convert_to<double>(), p[1].convert_to<double>(), p[2].convert_to<double>());
    if (row(q) != p) return false;
    if (std::binary_search(vertices_.begin(), vertices_.end(), q, isBefore)) return true;
    const Vec3& d = vertices_[0];
    for (const auto& [i, j, k] : faces_) {
      const Vec3 &a = vertices_[i], &b = vertices_[j], &c = vertices_[k];
      // The predicates only choose which simplices are worth a proof.
      const int side = planeSide(a, b, c, d);
      if (side == 0 || planeSide(a, b, c, q) == -side || planeSide(q, b, c, d) == -side ||
          planeSide(a, q, c, d) == -side || planeSide(a, b, q, d) == -side)
        continue;
      if (inTetrahedron({row(a), row(b), row(c), row(d)}, p)) return true;
    }
    if (!faces_.empty()) return false;
    for (std::size_t i = 0; i < vertices_.size(); ++i)
      for (std::size_t k = i; k < vertices_.size(); ++k)
        if (inTriangle(row(d), row(vertices_[i]), row(vertices_[k]), p)) return true;
    return false;
  }

 private:
  static bool isBefore(const Vec3& p, const Vec3& q) {
    return std::lexicographical_compare(p.data(), p.data() + 3, q.data(), q.data() + 3);
  }

  std::vector<Vec3> vertices_;
  Rational size_;
  std::vector<std::array<std::uint32_t, 3>> faces_;
};

}  // namespace corridor::exact
