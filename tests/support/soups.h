#pragma once

#include <cmath>
#include <random>
#include <vector>

#include <Eigen/Geometry>

#include "collision/geometry/convex_part.h"
#include "tests/support/meshes.h"

namespace corridor::test {

/// Returns `count` triangles of very different sizes, some of them slivers or degenerate, and some
/// duplicates of these. Each triangle lies within about √3·s of a point of the cube [−1, 1]³
/// (metres), for an s between e^-2 and e^2 times `size`.
inline TriangleMesh soup(std::mt19937_64& random, int count, double size) {
  std::uniform_real_distribution<double> real(-1, 1);
  const auto any = [&] {
    const double x = real(random), y = real(random), z = real(random);
    return Vec3(x, y, z);
  };
  TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    const Vec3 c = any();
    const double s = size * std::exp(2 * real(random));
    const Vec3 p = c + s * any(), q = c + s * any(),
               r = i % 5 == 0 ? Vec3(p + 1e-7 * s * any()) : Vec3(c + s * any());
    add(mesh, p, q, i % 7 == 0 ? q : r);
    if (i % 11 == 0) mesh.triangles.push_back(mesh.triangles.back());
  }
  return mesh;
}

/// Returns a random rotation and translation. The coordinates of the translation have a standard
/// deviation of `distance`.
inline Transform anyPose(std::mt19937_64& random, double distance) {
  std::normal_distribution<double> normal;
  Transform X;
  const double w = normal(random), x = normal(random), y = normal(random), z = normal(random);
  X.m = Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix();
  for (int i = 0; i < 3; ++i) X.t[i] = distance * normal(random);
  return X;
}

/// Returns spheres, capsules, cylinders, boxes and hulls of about `size` at random poses. The
/// coordinates of their frames' origins have a standard deviation of 0.5 m.
inline std::vector<ConvexPart> parts(std::mt19937_64& random, int count, double size) {
  std::uniform_real_distribution<double> real(0.2, 1);
  std::vector<ConvexPart> all;
  for (int i = 0; i < count; ++i) {
    const double r = size * real(random), l = size * real(random);
    const auto shape = [&]() -> Primitive {
      switch (i % 5) {
        case 1:
          return Capsule{r, l};
        case 2:
          return Cylinder{r, l};
        case 3:
          return Box{Vec3(r, l, size)};
        case 4:
          return Convex{{Vec3(0, 0, 0), Vec3(r, 0, l), Vec3(0, l, 0), Vec3(0, r, r)}};
        default:
          return Sphere{r};
      }
    };
    all.push_back(placed(shape(), anyPose(random, 0.5)));
  }
  return all;
}

}  // namespace corridor::test
