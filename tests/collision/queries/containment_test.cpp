#include "collision/queries/containment.h"

#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "tests/support/meshes.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

TriangleMesh cube(const Vec3& center, double half) {
  return test::box(center - Vec3::Constant(half), center + Vec3::Constant(half));
}

struct Solid {
  explicit Solid(const TriangleMesh& mesh) : tree(mesh), components(findComponents(mesh)) {}
  operator MeshBody() const { return {tree, components}; }  // NOLINT
  ObbTree tree;
  MeshComponents components;
};

bool holds(const Solid& solid, const Vec3& p) {
  QueryContext context;
  return containing(Posed<MeshBody>(solid), p, {}, context).has_value();
}

TEST(MeshComponents, SharedEdgesConnectSharedCornersDoNot) {
  TriangleMesh mesh = cube(Vec3(0, 0, 0), 1);
  test::addBox(mesh, Vec3(1, 1, 1), Vec3(3, 3, 3));  // meets the first in a corner
  test::addBox(mesh, Vec3(8, -1, -1), Vec3(10, 1, 1));
  mesh.triangles.pop_back();  // leaves the third open
  const MeshComponents found = findComponents(mesh);
  ASSERT_EQ(found.components.size(), 3U);
  EXPECT_TRUE(found.components[0].watertight);
  EXPECT_TRUE(found.components[1].watertight);
  EXPECT_FALSE(found.components[2].watertight);
  EXPECT_EQ(found.components[1].upper, Vec3(3, 3, 3));
}

TEST(Containment, PointsOfAGridInTwoOverlappingShells) {
  TriangleMesh mesh = cube(Vec3(0, 0, 0), 1);
  test::addBox(mesh, Vec3(0, -0.5, -0.5), Vec3(2, 0.5, 0.5));
  const Solid solid(mesh);
  int inside = 0;
  // The points are 1/8 off the faces, and the grid has the mesh's own symmetries.
  for (double x = -1.875; x < 3; x += 0.25)
    for (double y = -1.875; y < 2; y += 0.25)
      for (double z = -1.875; z < 2; z += 0.25) {
        const bool first = std::abs(x) < 1 && std::abs(y) < 1 && std::abs(z) < 1;
        const bool second = std::abs(x - 1) < 1 && std::abs(y) < 0.5 && std::abs(z) < 0.5;
        EXPECT_EQ(holds(solid, {x, y, z}), first || second) << x << " " << y << " " << z;
        inside += first || second;
      }
  EXPECT_GT(inside, 500);
}

TEST(Containment, MirroredMeshesAreAsSolid) {
  TriangleMesh mesh = cube(Vec3(0, 2, 0), 1);
  for (Vec3& v : mesh.vertices) v[1] = -v[1];
  const Solid solid(mesh);
  EXPECT_TRUE(holds(solid, Vec3(0, -2, 0.1)));
  EXPECT_FALSE(holds(solid, Vec3(0, 2, 0.1)));
}

TEST(Containment, AHollowShellIsFilled) {
  TriangleMesh mesh = cube(Vec3(0, 0, 0), 2);
  TriangleMesh hollow = cube(Vec3(0, 0, 0), 1);
  for (auto& t : hollow.triangles) {
    std::swap(t[1], t[2]);
    for (std::uint32_t& corner : t) corner += 8;
  }
  mesh.vertices.insert(mesh.vertices.end(), hollow.vertices.begin(), hollow.vertices.end());
  mesh.triangles.insert(mesh.triangles.end(), hollow.triangles.begin(), hollow.triangles.end());
  const Solid robot(mesh);
  EXPECT_EQ(robot.components.components.size(), 2U);
  EXPECT_TRUE(holds(robot, Vec3(0, 0, 0)));
  QueryContext context;
  const Solid obstacle(cube(Vec3(0.1, 0.2, 0.3), 0.1));
  EXPECT_FALSE(interference(Posed(robot.tree), Posed(obstacle.tree), context));
  EXPECT_TRUE(enclosed(Posed<MeshBody>(robot), Posed<MeshBody>(obstacle), context));
  EXPECT_FALSE(enclosed(Posed<MeshBody>(obstacle), Posed<MeshBody>(robot), context));
}

TEST(Containment, OneComponentInsideAnotherOutside) {
  const Solid solid(cube(Vec3(0, 0, 0), 1));
  TriangleMesh mesh = cube(Vec3(5, 0, 0), 0.1);
  test::addBox(mesh, Vec3(0.2, 0, 0.1), Vec3(0.4, 0.2, 0.3));
  const Solid inner(mesh);
  QueryContext context;
  const auto hit = enclosed(Posed<MeshBody>(solid), Posed<MeshBody>(inner), context);
  ASSERT_TRUE(hit);
  EXPECT_LT(hit->a, 12U);
  EXPECT_GE(hit->b, 12U) << "a triangle of the component inside";
  const Transform away{Mat3::Identity(), Vec3(0, 4, 0)};
  EXPECT_FALSE(enclosed(Posed<MeshBody>(solid, away), Posed<MeshBody>(inner), context));
}

TEST(Containment, PrimitivesInSolidMeshes) {
  const Solid solid(cube(Vec3(0, 0, 0), 1));
  QueryContext context;
  const ConvexPart ball{{Vec3(0.2, 0.1, 0)}, 0.1, false};
  EXPECT_TRUE(enclosed(Posed<MeshBody>(solid), Posed(ball), context));
  EXPECT_FALSE(
      enclosed(Posed<MeshBody>(solid), Posed(ball, {Mat3::Identity(), Vec3(3, 0, 0)}), context));
  // A convex part is solid by itself: a mesh inside it is reported by `interference`.
  const ObbTree big(ConvexPart{{Vec3(0, 0, 0)}, 5, false});
  EXPECT_TRUE(interference(Posed(big), Posed(solid.tree), context));
  EXPECT_TRUE(interference(Posed(solid.tree), Posed(big), context));
}

/// Points below the apex of a fan of thousands of needles, where the first ray may meet edges.
/// Compared with the closed form, under two rotations and far away.
TEST(Containment, FineMeshesUnderTwoMaps) {
  std::mt19937_64 random(test::testSeed(31));
  const auto real = [&] { return std::uniform_real_distribution(-1.0, 1.0)(random); };
  TriangleMesh mesh;  // a double cone
  const int n = 2'000;
  mesh.vertices = {Vec3(0, 0, 1), Vec3(0, 0, -1)};
  for (int i = 0; i < n; ++i)
    mesh.vertices.emplace_back(std::cos(2 * 3.14159265358979 * i / n),
                               std::sin(2 * 3.14159265358979 * i / n), 0);
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t p = 2 + i, q = 2 + (i + 1) % n;
    mesh.triangles.push_back({0, p, q});
    mesh.triangles.push_back({1, q, p});
  }
  const Solid solid(mesh);
  ASSERT_EQ(solid.components.components.size(), 1U);
  ASSERT_TRUE(solid.components.components[0].watertight);
  QueryContext context;
  int inside = 0;
  for (int k = 0; k < 2'000; ++k) {
    const auto turn = [&] {
      return Eigen::Quaterniond(real(), real(), real(), real()).normalized().toRotationMatrix();
    };
    const Transform X_WS{turn(), Vec3(real(), real(), real()) * (k % 2 ? 1e5 : 1)};
    const Vec3 p = k % 7 == 0 ? Vec3(0, 0, real()) : Vec3(real(), real(), real());
    const double depth = 1 - std::abs(p[2]) - std::hypot(p[0], p[1]);
    if (std::abs(depth) < 1e-4) continue;
    const Transform X_SP{turn(), Vec3(real(), real(), real())};
    const Transform X_WP = X_WS * X_SP;
    const Vec3 local = X_SP.m.transpose() * (p - X_SP.t);
    EXPECT_EQ(containing(Posed<MeshBody>(solid, X_WS), local, X_WP, context).has_value(), depth > 0)
        << k;
    inside += depth > 0;
  }
  EXPECT_GT(inside, 300);
}

}  // namespace
}  // namespace corridor
