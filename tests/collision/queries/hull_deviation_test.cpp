#include "collision/queries/hull_deviation.h"

#include <cmath>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "tests/support/meshes.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

Polytope hullOf(const TriangleMesh& mesh) {
  return Polytope(mesh.vertices);
}

/// Returns the unit cube, rotated and far from the origin. On top, the cube has a hollow: a pyramid
/// with the base [0.5 − a, 0.5 + a]² and the depth h.
TriangleMesh hollowCube(double a, double h, const Transform& X) {
  TriangleMesh mesh;
  const auto quad = [&](Vec3 p, Vec3 q, Vec3 r, Vec3 s) {
    test::add(mesh, X * p, X * q, X * r);
    test::add(mesh, X * p, X * r, X * s);
  };
  quad({0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0});
  quad({0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1});
  quad({1, 0, 0}, {1, 1, 0}, {1, 1, 1}, {1, 0, 1});
  quad({1, 1, 0}, {0, 1, 0}, {0, 1, 1}, {1, 1, 1});
  quad({0, 1, 0}, {0, 0, 0}, {0, 0, 1}, {0, 1, 1});
  const Vec3 outer[] = {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  const Vec3 tip(0.5, 0.5, 1 - h);
  const auto inner = [&](int i) {
    return Vec3(0.5 + 2 * a * (outer[i].x() - 0.5), 0.5 + 2 * a * (outer[i].y() - 0.5), 1);
  };
  for (int i = 0; i < 4; ++i) {
    const int k = (i + 1) % 4;
    quad(outer[i], outer[k], inner(k), inner(i));
    test::add(mesh, X * inner(i), X * inner(k), X * tip);
  }
  return mesh;
}

Transform anywhere(std::mt19937_64& random) {
  std::uniform_real_distribution<double> real(-1, 1);
  Transform X;
  const double angle = 3 * real(random), x = real(random), y = real(random), z = real(random);
  X.m = Eigen::AngleAxisd(angle, Vec3(x, y, z).normalized()).matrix();
  X.t = 10 * Vec3(y, z, x);
  return X;
}

/// The centre of the pyramid's base has the distance h·a/√(h² + a²) from the pyramid's sides. For h
/// ≤ a, no other point of the mesh is closer to the centre. So this is the centre's distance from
/// the mesh, and the largest distance of any point of the hull.
TEST(HullDeviation, OfAHollowIsKnown) {
  std::mt19937_64 random(test::testSeed(71));
  for (const double h : {0.3, 0.05, 1e-3})
    for (const double a : {0.45, 0.3}) {
      const TriangleMesh mesh = hollowCube(a, h, anywhere(random));
      const double truth = h * a / std::hypot(h, a);
      const HullDeviation above = hullDeviation(hullOf(mesh), mesh, 1.01 * truth);
      EXPECT_TRUE(above.within) << h << ' ' << a;
      EXPECT_GE(above.upper, truth * (1 - 1e-9)) << h << ' ' << a;
      EXPECT_LE(above.upper, 1.01 * truth) << h << ' ' << a;
      const HullDeviation below = hullDeviation(hullOf(mesh), mesh, 0.9 * truth);
      EXPECT_FALSE(below.within) << h << ' ' << a;
      EXPECT_GT(below.found, 0.9 * truth) << h << ' ' << a;
      EXPECT_LE(below.found, truth * (1 + 1e-6)) << h << ' ' << a;
    }
}

/// The hull of a convex mesh has the same surface as the mesh, even if the triangles of the mesh
/// divide the faces in another way. So the deviation must be no more than rounding.
TEST(HullDeviation, OfConvexMeshesIsRounding) {
  std::mt19937_64 random(test::testSeed(72));
  TriangleMesh ball;
  std::normal_distribution<double> normal;
  std::vector<Vec3> points;
  for (int i = 0; i < 300; ++i) {
    const double x = normal(random), y = normal(random), z = normal(random);
    points.push_back(Vec3(x, y, z).normalized());
  }
  const Polytope hull(points);
  for (const Polytope::Face& face : hull.faces())
    test::add(ball, hull.vertices()[face[0]], hull.vertices()[face[1]], hull.vertices()[face[2]]);
  const HullDeviation same = hullDeviation(hull, ball, 1e-9);
  EXPECT_TRUE(same.within);
  EXPECT_LE(same.upper, 1e-11);
  const TriangleMesh cube = hollowCube(0.3, 0, anywhere(random));
  EXPECT_TRUE(hullDeviation(hullOf(cube), cube, 1e-4).within);
}

/// Meshes whose faces are cut into many triangles, as programs write them: boxes, and a cylinder.
/// Their hulls have other triangles.
TEST(HullDeviation, OfFinelyTessellatedConvexMeshesIsWithin) {
  std::mt19937_64 random(test::testSeed(73));
  for (const int n : {1, 10, 25}) {
    const Transform X = anywhere(random);
    TriangleMesh box = test::tessellatedCube(n);
    for (Vec3& v : box.vertices) v = X * v;
    const HullDeviation d = hullDeviation(hullOf(box), box, 1e-4);
    EXPECT_TRUE(d.within) << n;
    EXPECT_LE(d.upper, 1e-4) << n;
  }
  TriangleMesh can;
  const Transform X = anywhere(random);
  for (int i = 0; i < 64; ++i) {
    const auto at = [&](int k, double r, double z) {
      const double angle = M_PI * (i + k) / 32;
      return X * Vec3(r * std::cos(angle), r * std::sin(angle), z);
    };
    for (int z = 0; z < 8; ++z) {
      test::add(can, at(0, 1, z / 8.0), at(1, 1, z / 8.0), at(1, 1, (z + 1) / 8.0));
      test::add(can, at(0, 1, z / 8.0), at(1, 1, (z + 1) / 8.0), at(0, 1, (z + 1) / 8.0));
    }
    for (const double z : {0.0, 1.0}) test::add(can, at(0, 0, z), at(0, 1, z), at(1, 1, z));
  }
  const HullDeviation d = hullDeviation(hullOf(can), can, 1e-4);
  EXPECT_TRUE(d.within);
  EXPECT_LE(d.upper, 1e-4);
}

/// A tetrahedron with one face pushed in. It is so small that squares of lengths underflow to 0.
TEST(HullDeviation, IsNotLostAtTinyScale) {
  for (const double s : {0x1p-500, 0x1p-530, 0x1p-540, 0x1p-700, 0x1p-1000}) {
    const Vec3 o = Vec3::Zero(), x(4 * s, 0, 0), y(0, 4 * s, 0), z(0, 0, 4 * s), in(s, s, s);
    TriangleMesh mesh;
    test::add(mesh, o, y, x);
    test::add(mesh, o, x, z);
    test::add(mesh, o, z, y);
    test::add(mesh, x, y, in);
    test::add(mesh, y, z, in);
    test::add(mesh, z, x, in);
    EXPECT_FALSE(hullDeviation(hullOf(mesh), mesh, 1e-4 * s).within) << s;
  }
}

/// The hull of two cubes that are apart bridges the gap between them. The distance of the point in
/// the middle from both cubes is half the gap.
TEST(HullDeviation, OfTwoCubesIsHalfTheGap) {
  TriangleMesh mesh = hollowCube(0.3, 0, {});
  Transform right;
  right.t.x() = 1.5;
  const TriangleMesh other = hollowCube(0.3, 0, right);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& t : other.triangles)
    mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  EXPECT_TRUE(hullDeviation(hullOf(mesh), mesh, 0.26).within);
  const HullDeviation found = hullDeviation(hullOf(mesh), mesh, 0.24);
  EXPECT_FALSE(found.within);
  EXPECT_NEAR(found.at.x(), 1.25, 0.011);
}

}  // namespace
}  // namespace corridor
