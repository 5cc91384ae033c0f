#include "collision/queries/self_intersections.h"

#include <iostream>
#include <random>

#include <gtest/gtest.h>

#include "collision/geometry/mesh_health.h"
#include "tests/support/meshes.h"
#include "tests/support/rational_contact.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::add;
using test::box;
using OwnPairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

OwnPairs found(const TriangleMesh& mesh) {
  QueryContext context;
  OwnPairs pairs;
  for (const PrimitivePair& p : selfIntersections(mesh, context)) pairs.emplace_back(p.a, p.b);
  return pairs;
}

TEST(SelfIntersections, NoneOfSoundMeshes) {
  EXPECT_EQ(found({}), OwnPairs());
  EXPECT_EQ(found(box(Vec3(0, 0, 0), Vec3(1, 2, 3))), OwnPairs())
      << "no triangle is reported with itself";
  std::mt19937_64 random(test::testSeed(63));
  TriangleMesh hills;  // a surface with one height at each (x, y): it cannot intersect itself
  for (int x = 0; x < 20; ++x)
    for (int y = 0; y < 20; ++y)
      hills.vertices.emplace_back(0.1 * x, 0.1 * y, std::uniform_real_distribution()(random));
  for (std::uint32_t x = 0; x < 19; ++x)
    for (std::uint32_t i = 20 * x; i < 20 * x + 19; ++i) {
      hills.triangles.push_back({i, i + 1, i + 21});
      hills.triangles.push_back({i, i + 21, i + 20});
    }
  EXPECT_EQ(found(hills), OwnPairs());
}

TEST(SelfIntersections, OfTwoPartsThatCross) {
  TriangleMesh mesh;
  add(mesh, Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0));
  add(mesh, Vec3(1, 1, -1), Vec3(1, 1, 1), Vec3(9, 9, 0));
  add(mesh, Vec3(0, 0, 5), Vec3(4, 0, 5), Vec3(0, 4, 5));
  EXPECT_EQ(found(mesh), OwnPairs({{0, 1}}));
}

TEST(SelfIntersections, ACornerInTheMiddleOfAnEdge) {
  TriangleMesh mesh;
  add(mesh, Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0));
  add(mesh, Vec3(2, 0, 0), Vec3(4, -1, 0), Vec3(0, -1, 0));
  EXPECT_EQ(found(mesh), OwnPairs({{0, 1}}));
}

TEST(SelfIntersections, BeyondOneSharedCorner) {
  const Triangle t = {Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)};
  const auto with = [&](const Vec3& p, const Vec3& q) {
    TriangleMesh mesh;
    add(mesh, t);
    add(mesh, p, Vec3(-0.0, 0, 0), q);
    return found(mesh).size();
  };
  EXPECT_EQ(with(Vec3(-1, 0, 1), Vec3(0, -1, 1)), 0u);
  EXPECT_EQ(with(Vec3(9, 9, 1), Vec3(9, 9, -1)), 1u) << "leaves through t's far edge";
  EXPECT_EQ(with(Vec3(1, 1, 1), Vec3(1, 1, -1)), 1u) << "ends within t";
  EXPECT_EQ(with(Vec3(9, 0, 0), Vec3(9, -1, 3)), 1u) << "along an edge of both";
  EXPECT_EQ(with(Vec3(9, 1, 0), Vec3(1, 9, 0)), 1u) << "in one plane";
  EXPECT_EQ(with(Vec3(-9, 1, 0), Vec3(1, -9, 0)), 0u) << "in one plane, the other way";
}

TEST(SelfIntersections, BeyondASharedEdge) {
  const Triangle t = {Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)};
  const auto with = [&](const Vec3& p) {
    TriangleMesh mesh;
    add(mesh, t);
    add(mesh, t[1], t[0], p);
    return found(mesh).size();
  };
  EXPECT_EQ(with(Vec3(0, -4, 0)), 0u) << "flat";
  EXPECT_EQ(with(Vec3(1, 1, 1e-300)), 0u) << "folded, nearly all the way";
  EXPECT_EQ(with(Vec3(1, 1, 0)), 1u) << "folded over";
  EXPECT_EQ(with(Vec3(9, 9, 0)), 1u);
  EXPECT_EQ(with(Vec3(4, 4, 0)), 1u) << "neither holds the other's corner";
  EXPECT_EQ(with(Vec3(0, 4, 0)), 0u) << "repeated, which is counted elsewhere";
}

TEST(SelfIntersections, SmallBesideALargeMesh) {
  TriangleMesh mesh;
  add(mesh, Vec3(0, 0, 0), Vec3(1e-3, 0, 0), Vec3(0, 1e-3, 0));
  add(mesh, Vec3(2e-4, 2e-4, -1e-3), Vec3(2e-4, 2e-4, 1e-3), Vec3(1e-3, 1e-3, 0));
  add(mesh, Vec3(2000, 0, 0), Vec3(2000, 1, 0), Vec3(2000, 0, 1));
  EXPECT_EQ(inspectMesh(mesh).degenerateTriangles, 2u) << "for people";
  EXPECT_EQ(found(mesh), OwnPairs({{0, 1}}));
}

TEST(SelfIntersections, CollinearTrianglesAreIgnored) {
  TriangleMesh mesh;
  add(mesh, Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0));
  add(mesh, Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(2, 0, 0));
  add(mesh, Vec3(1, 1, 1), Vec3(1, 1, -1), Vec3(1, 1, -1));
  EXPECT_EQ(found(mesh), OwnPairs());
}

/// Returns a triangle without the part near its shared corner or edge: this part is cut off at
/// 2^-12 of the way to the other corners. The remaining part consists of two triangles if a corner
/// is shared, and is one triangle if an edge is shared.
std::vector<Triangle> without(const Triangle& t, const std::vector<int>& shared) {
  const auto toward = [](const Vec3& from, const Vec3& to) {
    return Vec3(from + 0x1p-12 * (to - from));
  };
  if (shared.empty()) return {t};
  if (shared.size() == 2) {
    const Vec3& c = t[static_cast<std::size_t>(3 - shared[0] - shared[1])];
    return {{c, toward(t[static_cast<std::size_t>(shared[0])], c),
             toward(t[static_cast<std::size_t>(shared[1])], c)}};
  }
  const auto v = static_cast<std::size_t>(shared[0]);
  const Vec3 &p = t[(v + 1) % 3], &q = t[(v + 2) % 3], x = toward(t[v], p), y = toward(t[v], q);
  return {{p, q, x}, {q, x, y}};
}

/// Corners lie on a small grid. So two triangles meet either in their shared corner or edge, or far
/// from it. On a grid of 5, a cut of 2^-12 removes no other point of an intersection.
TEST(SelfIntersections, RandomMeshesAgainstRationals) {
  std::mt19937_64 random(test::testSeed(64));
  std::array<int, 3> crossing = {}, clear = {};
  for (int n = 0; n < 300 / test::kSlowdown; ++n) {
    TriangleMesh mesh;
    const auto whole = [&](unsigned below) { return static_cast<double>(random() % below); };
    for (int i = 0; i < 9; ++i) {
      const double x = whole(5), y = whole(5), z = whole(n % 4 ? 5 : 1);
      mesh.vertices.emplace_back(x, y, z);
    }
    while (mesh.triangles.size() < 12)
      mesh.triangles.push_back({static_cast<std::uint32_t>(random() % 9),
                                static_cast<std::uint32_t>(random() % 9),
                                static_cast<std::uint32_t>(random() % 9)});
    const auto qualities = triangleQualities(mesh);
    OwnPairs expected;
    for (std::uint32_t s = 0; s < 12; ++s)
      for (std::uint32_t t = s + 1; t < 12; ++t) {
        if (qualities[s] == TriangleQuality::degenerate ||
            qualities[t] == TriangleQuality::degenerate)
          continue;
        const Triangle a = {mesh.corner(s, 0), mesh.corner(s, 1), mesh.corner(s, 2)},
                       b = {mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)};
        std::vector<int> sharedA, sharedB;
        for (int i = 0; i < 3; ++i)
          for (int k = 0; k < 3; ++k)
            if (a[static_cast<std::size_t>(i)] == b[static_cast<std::size_t>(k)])
              sharedA.push_back(i), sharedB.push_back(k);
        if (sharedA.size() == 3) continue;
        bool meet = false;
        for (const Triangle& partA : without(a, sharedA))
          for (const Triangle& partB : without(b, sharedB))
            meet = meet || test::rationalContact(partA, {}, partB, {});
        (meet ? crossing : clear).at(sharedA.size())++;
        if (meet) expected.emplace_back(s, t);
      }
    ASSERT_EQ(found(mesh), expected) << n;
  }
  for (std::size_t shared = 0; shared < 3; ++shared) {
    std::cout << shared << " shared: " << crossing[shared] << " cross, " << clear[shared]
              << " don't\n";
    EXPECT_GT(crossing[shared], 20);
    EXPECT_GT(clear[shared], 20);
  }
}

}  // namespace
}  // namespace corridor
