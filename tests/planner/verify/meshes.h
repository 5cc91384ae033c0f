#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include "planner/verify/verify_path.h"

namespace corridor::test {

/// The surface of the box from `lower` to `upper`.
inline TriangleMesh boxMesh(const Vec3& lower, const Vec3& upper) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back((i & 1 ? upper : lower).x(), (i & 2 ? upper : lower).y(),
                               (i & 4 ? upper : lower).z());
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

inline TriangleMesh oneTriangle(const Vec3& a, const Vec3& b, const Vec3& c) {
  return {{a, b, c}, {{0, 1, 2}}};
}

inline RigidPose poseOf(const Vec3& p, double angle = 0, const Vec3& axis = Vec3::UnitZ()) {
  return {p, Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis.normalized()))};
}

inline Vec3 randomVec(std::mt19937_64& random, double size) {
  std::uniform_real_distribution<double> uniform(-size, size);
  const double x = uniform(random), y = uniform(random), z = uniform(random);
  return {x, y, z};
}

inline RigidPose randomPose(std::mt19937_64& random, double size) {
  std::normal_distribution<double> normal;
  const double w = normal(random), x = normal(random), y = normal(random), z = normal(random);
  return {randomVec(random, size), Eigen::Quaterniond(w, x, y, z)};
}

/// Triangles of edge length about `edge`, scattered over a cube of half edge `size`.
inline TriangleMesh randomSoup(std::mt19937_64& random, int triangles, double size, double edge) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(triangles); ++i) {
    const Vec3 centre = randomVec(random, size);
    for (int j = 0; j < 3; ++j) mesh.vertices.push_back(centre + randomVec(random, edge));
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

}  // namespace corridor::test
