#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "collision/geometry/triangle_mesh.h"
#include "collision/predicates/triangle.h"

/// Helpers that build small meshes and read their triangles.
namespace corridor::test {

/// Returns the triangle with index t.
inline Triangle corners(const TriangleMesh& mesh, std::size_t t) {
  return {mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)};
}

/// Adds a triangle with three new vertices, which it shares with no other triangle.
inline void add(TriangleMesh& mesh, const Vec3& p, const Vec3& q, const Vec3& r) {
  const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {p, q, r});
  mesh.triangles.push_back({n, n + 1, n + 2});
}
inline void add(TriangleMesh& mesh, const Triangle& t) {
  add(mesh, t[0], t[1], t[2]);
}

/// Returns a sheet of 2n² triangles that share vertices; `point(i, k)` is a vertex, 0 ≤ i, k ≤ n.
template <class Point>
TriangleMesh sheet(std::uint32_t n, const Point& point) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i <= n; ++i)
    for (std::uint32_t k = 0; k <= n; ++k) mesh.vertices.push_back(point(i, k));
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t k = 0; k < n; ++k) {
      const std::uint32_t v = i * (n + 1) + k;
      mesh.triangles.push_back({v, v + 1, v + n + 1});
      mesh.triangles.push_back({v + 1, v + n + 2, v + n + 1});
    }
  return mesh;
}

/// Returns the surface of the cube [−1, 1]³ as 12n² triangles that share no vertices.
inline TriangleMesh tessellatedCube(int n) {
  TriangleMesh mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0})
      for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
          const auto at = [&](int u, int v) {
            Vec3 p = Vec3::Constant(side);
            p[(axis + 1) % 3] = -1 + 2.0 * (i + u) / n;
            p[(axis + 2) % 3] = -1 + 2.0 * (k + v) / n;
            return p;
          };
          add(mesh, at(0, 0), at(1, 0), at(1, 1));
          add(mesh, at(0, 0), at(1, 1), at(0, 1));
        }
  return mesh;
}

/// Adds the box [low, high], mapped by x ↦ Mx, with eight new vertices. Its triangles face outward
/// if det M > 0.
inline void addBox(TriangleMesh& mesh, const Vec3& low, const Vec3& high,
                   const Mat3& M = Mat3::Identity()) {
  const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int i = 0; i < 8; ++i)
    mesh.vertices.push_back(
        M * Vec3((i & 1 ? high : low)[0], (i & 2 ? high : low)[1], (i & 4 ? high : low)[2]));
  const std::array<std::uint32_t, 3> faces[] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6},
                                                {0, 1, 4}, {1, 5, 4}, {2, 6, 3}, {3, 6, 7},
                                                {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  for (const auto& f : faces) mesh.triangles.push_back({n + f[0], n + f[1], n + f[2]});
}

inline TriangleMesh box(const Vec3& low, const Vec3& high) {
  TriangleMesh mesh;
  addBox(mesh, low, high);
  return mesh;
}

/// Returns S, the largest coordinate of |m||v| + |t| over the corners v of the triangle, where X
/// maps v to m·v + t, and |·| is the absolute value entry by entry. Bounds on rounding are
/// multiples of S.
inline double errorScale(const Triangle& t, const Transform& X) {
  double scale = 0;
  for (const Vec3& p : t)
    scale = std::max(scale, (X.m.cwiseAbs() * p.cwiseAbs() + X.t.cwiseAbs()).maxCoeff());
  return scale;
}
inline double errorScale(const Triangle& a, const Transform& X_WA, const Triangle& b,
                         const Transform& X_WB) {
  return std::max(errorScale(a, X_WA), errorScale(b, X_WB));
}

inline double errorScale(const TriangleMesh& mesh, const Transform& X) {
  double scale = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    scale = std::max(scale, errorScale(corners(mesh, t), X));
  return scale;
}

}  // namespace corridor::test
