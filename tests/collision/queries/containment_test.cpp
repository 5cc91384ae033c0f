#include "collision/queries/containment.h"

#include <algorithm>
#include <array>
#include <map>
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
  operator MeshWithComponents() const { return {tree, components}; }  // NOLINT
  ObbTree tree;
  MeshComponents components;
};

bool holds(const Solid& solid, const Vec3& p) {
  QueryContext context;
  return containing(Posed<MeshWithComponents>(solid), p, {}, context).has_value();
}

TEST(MeshComponents, SharedEdgesConnectSharedCornersDoNot) {
  TriangleMesh mesh = cube(Vec3(0, 0, 0), 1);
  test::addBox(mesh, Vec3(1, 1, 1), Vec3(3, 3, 3));  // meets the first box in a corner
  test::addBox(mesh, Vec3(8, -1, -1), Vec3(10, 1, 1));
  mesh.triangles.pop_back();  // leaves the third box open
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
  // The points of the grid are at least 1/8 away from all faces, and the grid has the same
  // symmetries as the mesh.
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
  EXPECT_TRUE(
      findEnclosed(Posed<MeshWithComponents>(robot), Posed<MeshWithComponents>(obstacle), context));
  EXPECT_FALSE(
      findEnclosed(Posed<MeshWithComponents>(obstacle), Posed<MeshWithComponents>(robot), context));
}

TEST(Containment, OneComponentInsideAnotherOutside) {
  const Solid solid(cube(Vec3(0, 0, 0), 1));
  TriangleMesh mesh = cube(Vec3(5, 0, 0), 0.1);
  test::addBox(mesh, Vec3(0.2, 0, 0.1), Vec3(0.4, 0.2, 0.3));
  const Solid inner(mesh);
  QueryContext context;
  const auto hit =
      findEnclosed(Posed<MeshWithComponents>(solid), Posed<MeshWithComponents>(inner), context);
  ASSERT_TRUE(hit);
  EXPECT_LT(hit->a, 12U);
  EXPECT_GE(hit->b, 12U) << "a triangle of the component inside";
  const Transform away{Mat3::Identity(), Vec3(0, 4, 0)};
  EXPECT_FALSE(findEnclosed(Posed<MeshWithComponents>(solid, away),
                            Posed<MeshWithComponents>(inner), context));
}

TEST(Containment, PrimitivesInSolidMeshes) {
  const Solid solid(cube(Vec3(0, 0, 0), 1));
  QueryContext context;
  const ConvexPart ball{{Vec3(0.2, 0.1, 0)}, 0.1, false};
  EXPECT_TRUE(findEnclosed(Posed<MeshWithComponents>(solid), Posed(ball), context));
  EXPECT_FALSE(findEnclosed(Posed<MeshWithComponents>(solid),
                            Posed(ball, {Mat3::Identity(), Vec3(3, 0, 0)}), context));
  // A convex part is always solid, so `interference` reports a mesh that is inside the part.
  const ObbTree big(ConvexPart{{Vec3(0, 0, 0)}, 5, false});
  EXPECT_TRUE(interference(Posed(big), Posed(solid.tree), context));
  EXPECT_TRUE(interference(Posed(solid.tree), Posed(big), context));
}

/// Returns whether a comb (see `comb`) fills the unit cell at the position x along the axis of the
/// comb, and at y and z across this axis.
bool inComb(int plates, int width, int x, int y, int z) {
  const bool within = x >= 0 && x < 2 * plates - 1 && y >= 0 && y < width && z >= 0 && z < width;
  return within && (x % 2 == 0 || y == 0);
}

/// Returns the surface of a comb: a row of plates along `axis`, with thickness 1 and gaps of 1, and
/// a spine that joins the plates. The surface is the boundary of unit cells, with a vertex at every
/// corner of a cell.
TriangleMesh comb(int axis, int plates, int width) {
  const int length = 2 * plates - 1;
  const auto filled = [&](const Eigen::Vector3i& cell) {
    return inComb(plates, width, cell[axis], cell[(axis + 1) % 3], cell[(axis + 2) % 3]);
  };
  TriangleMesh mesh;
  std::map<std::array<int, 3>, std::uint32_t> vertices;
  const auto vertex = [&](const Eigen::Vector3i& p) {
    const auto [found, added] =
        vertices.try_emplace({p[0], p[1], p[2]}, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (added) mesh.vertices.push_back(p.cast<double>());
    return found->second;
  };
  const int most = std::max(length, width);
  for (int i = 0; i < most * most * most; ++i) {
    const Eigen::Vector3i cell(i % most, i / most % most, i / most / most);
    if (!filled(cell)) continue;
    for (int k = 0; k < 6; ++k) {
      const Eigen::Vector3i x = Eigen::Vector3i::Unit(k / 2),
                            y = Eigen::Vector3i::Unit((k / 2 + 1) % 3),
                            z = Eigen::Vector3i::Unit((k / 2 + 2) % 3);
      if (filled(k % 2 ? Eigen::Vector3i(cell + x) : Eigen::Vector3i(cell - x))) continue;
      const Eigen::Vector3i low = k % 2 ? Eigen::Vector3i(cell + x) : cell;
      const std::uint32_t p = vertex(low), q = vertex(low + y), r = vertex(low + z),
                          s = vertex(low + y + z);
      mesh.triangles.push_back(k % 2 ? std::array{p, q, s} : std::array{p, s, q});
      mesh.triangles.push_back(k % 2 ? std::array{p, s, r} : std::array{p, r, s});
    }
  }
  return mesh;
}

/// A ray from inside a plate crosses other plates, so the number of crossings is odd, but not 1.
TEST(Containment, RaysLeaveAndEnterAgain) {
  for (int axis = 0; axis < 3; ++axis) {
    const Solid solid(comb(axis, 4, 5));
    ASSERT_EQ(solid.components.components.size(), 1U);
    ASSERT_TRUE(solid.components.components[0].watertight);
    for (int i = 0; i < 9 * 7 * 7; ++i) {
      const int x = i % 9 - 1, y = i / 9 % 7 - 1, z = i / 63 - 1;
      Vec3 p;
      p[axis] = x + 0.4, p[(axis + 1) % 3] = y + 0.7, p[(axis + 2) % 3] = z + 0.3;
      EXPECT_EQ(holds(solid, p), inComb(4, 5, x, y, z)) << axis << ": " << p.transpose();
    }
  }
}

/// At coordinates of 2^51 all doubles are multiples of ½, and so are the coordinates of the end
/// points of rays. Therefore many rays meet an edge or a vertex of the mesh, or lie in the plane of
/// a triangle.
TEST(Containment, RaysThroughEdgesAndVertices) {
  for (int axis = 0; axis < 3; ++axis) {
    TriangleMesh mesh = comb(axis, 2, 4);
    const Vec3 far = Vec3::Constant(0x1p51);
    for (Vec3& v : mesh.vertices) v += far;
    const Solid solid(mesh);
    ASSERT_TRUE(solid.components.components[0].watertight);
    for (int i = 0; i < 5 * 6 * 6; ++i) {
      const int x = i % 5 - 1, y = i / 5 % 6 - 1, z = i / 30 - 1;
      Vec3 p;
      p[axis] = x + 0.5, p[(axis + 1) % 3] = y + 0.5, p[(axis + 2) % 3] = z + 0.5;
      EXPECT_EQ(holds(solid, far + p), inComb(2, 4, x, y, z)) << axis << ": " << p.transpose();
    }
  }
}

/// Tests random points in and beside a double cone. Some are on its axis, below the apex of a fan
/// of thousands of needle-shaped triangles, where the first ray may meet edges. The answers are
/// compared with the closed form, under two rotations and far away.
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
    EXPECT_EQ(containing(Posed<MeshWithComponents>(solid, X_WS), local, X_WP, context).has_value(),
              depth > 0)
        << k;
    inside += depth > 0;
  }
  EXPECT_GT(inside, 300);
}

}  // namespace
}  // namespace corridor
