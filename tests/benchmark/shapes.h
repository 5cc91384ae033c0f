#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include <Eigen/Geometry>

#include "collision/core/transform.h"
#include "collision/geometry/triangle_mesh.h"

/// Meshes of any fineness, and random rotations, for benchmarks.
namespace corridor::bench {

/// Returns the length of the diagonal of a mesh's bounding box.
inline double diagonal(const TriangleMesh& mesh) {
  Vec3 low = mesh.vertices[0], high = low;
  for (const Vec3& v : mesh.vertices) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  return (high - low).norm();
}

/// Returns a mesh of 20·frequency² triangles with corners on the unit sphere: each face of an
/// icosahedron is divided. Corners along the edges of the icosahedron are stored once per face.
inline TriangleMesh icosphere(int frequency) {
  constexpr double g = std::numbers::phi;
  const std::array<Vec3, 12> corner = {Vec3(-1, g, 0),  Vec3(1, g, 0),   Vec3(-1, -g, 0),
                                       Vec3(1, -g, 0),  Vec3(0, -1, g),  Vec3(0, 1, g),
                                       Vec3(0, -1, -g), Vec3(0, 1, -g),  Vec3(g, 0, -1),
                                       Vec3(g, 0, 1),   Vec3(-g, 0, -1), Vec3(-g, 0, 1)};
  constexpr std::array<std::array<int, 3>, 20> faces = {
      {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
       {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
       {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
  TriangleMesh mesh;
  for (const auto& f : faces) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int i = 0; i <= frequency; ++i)
      for (int j = 0; j <= i; ++j)
        mesh.vertices.push_back(
            ((frequency - i) * corner[f[0]] + (i - j) * corner[f[1]] + j * corner[f[2]])
                .normalized());
    const auto at = [&](int i, int j) {
      return first + static_cast<std::uint32_t>(i * (i + 1) / 2 + j);
    };
    for (int i = 0; i < frequency; ++i)
      for (int j = 0; j <= i; ++j) {
        mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
        if (j < i) mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
      }
  }
  return mesh;
}

/// Returns the least distance of a facet's plane from the origin, for a mesh around the origin.
inline double inradius(const TriangleMesh& mesh) {
  double least = HUGE_VAL;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Vec3& p = mesh.corner(i, 0);
    const Vec3 n = (mesh.corner(i, 1) - p).cross(mesh.corner(i, 2) - p).normalized();
    least = std::min(least, std::abs(n.dot(p)));
  }
  return least;
}

/// Returns a torus with bumps (radii about 1 and 0.4, metres) of about `triangles` triangles.
inline TriangleMesh bumpyTorus(std::size_t triangles) {
  const auto rows = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(triangles) / 4) + 0.5);
  const std::uint32_t columns = 2 * rows;
  constexpr double turn = 2 * std::numbers::pi;
  TriangleMesh mesh;
  mesh.vertices.reserve(std::size_t{rows} * columns);
  mesh.triangles.reserve(std::size_t{2} * rows * columns);
  for (std::uint32_t i = 0; i < columns; ++i)
    for (std::uint32_t j = 0; j < rows; ++j) {
      const double u = turn * i / columns, v = turn * j / rows;
      const double r = 0.4 + 0.04 * std::sin(9 * u) * std::sin(5 * v);
      mesh.vertices.push_back({(1 + r * std::cos(v)) * std::cos(u),
                               (1 + r * std::cos(v)) * std::sin(u), r * std::sin(v)});
    }
  for (std::uint32_t i = 0; i < columns; ++i)
    for (std::uint32_t j = 0; j < rows; ++j) {
      const std::uint32_t k = (i + 1) % columns, l = (j + 1) % rows;
      mesh.triangles.push_back({i * rows + j, k * rows + j, k * rows + l});
      mesh.triangles.push_back({i * rows + j, k * rows + l, i * rows + l});
    }
  return mesh;
}

inline Mat3 randomRotation(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
      .normalized()
      .toRotationMatrix();
}

}  // namespace corridor::bench
