// Tests the refitting of 4-wide OBB trees: in rationals, the boxes must contain the moved
// triangles, and queries must have the verdicts of rebuilt trees.
#include <cmath>
#include <cstring>
#include <functional>
#include <random>

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

#include <gtest/gtest.h>

#include "collision/hierarchy/obb4_tree.h"
#include "collision/queries/distance_obb4.h"
#include "collision/queries/interference_obb4.h"
#include "tests/collision/queries/every_target.h"
#include "tests/support/brute_force.h"
#include "tests/support/meshes.h"
#include "tests/support/soups.h"
#include "tests/support/support.h"
#include "tests/support/tree_fault.h"

namespace corridor {
namespace {

struct Deformation {
  std::string name;
  std::function<Vec3(const Vec3&)> map;
};

/// Returns maps for a mesh of about the size 1. They make it small, large, mirrored, flat, far
/// away, tiny or huge. The image under each map differs much in position and scale from the image
/// under the previous map.
std::vector<Deformation> deformations(std::mt19937_64& random) {
  const auto noise = [&random](double size) {
    return [&random, size](const Vec3& p) {
      std::normal_distribution<double> normal;
      const double x = normal(random), y = normal(random), z = normal(random);
      return Vec3(p + size * Vec3(x, y, z));
    };
  };
  const auto scaled = [](int exponent) {
    return [exponent](const Vec3& p) {
      return Vec3(p.unaryExpr([&](double x) { return std::ldexp(x, exponent); }));
    };
  };
  return {
      {"small noise", noise(1e-9)},
      {"noise", noise(0.05)},
      {"large noise: no triangle is near its place", noise(10)},
      {"mirrored", [](const Vec3& p) { return Vec3(-p.x(), p.y(), p.z()); }},
      {"turned inside out", [](const Vec3& p) { return Vec3(p / p.squaredNorm()); }},
      {"sheared",
       [](const Vec3& p) { return Vec3(p.x() + 100 * p.y(), p.y(), p.z() - 30 * p.x()); }},
      {"flat", [](const Vec3& p) { return Vec3(p.x(), p.y(), 0.25); }},
      {"flat and oblique", [](const Vec3& p) { return Vec3(p.x(), p.y(), p.x() / 3 - p.y() / 7); }},
      {"a segment", [](const Vec3& p) { return Vec3(p.x() * Vec3(1, 2, 3)); }},
      {"a point", [](const Vec3&) { return Vec3(1, 2, 3); }},
      {"the origin", [](const Vec3&) { return Vec3(0, 0, 0); }},
      {"far away", [](const Vec3& p) { return Vec3(p + Vec3(1e12, -1e12, 1)); }},
      {"2^100", scaled(100)},
      {"2^-100", scaled(-100)},
      {"2^900", scaled(900)},
      {"2^-1040", scaled(-1040)},
      {"as it was", [](const Vec3& p) { return p; }},
  };
}

TriangleMesh moved(TriangleMesh mesh, const Deformation& by) {
  for (Vec3& v : mesh.vertices) v = by.map(v);
  return mesh;
}

/// Returns a wavy sheet of 2n² triangles that share vertices.
TriangleMesh bentSheet(std::uint32_t n) {
  return test::sheet(n, [n](std::uint32_t i, std::uint32_t k) {
    return Vec3(2.0 * i / n - 1, 2.0 * k / n - 1, 0.3 * std::sin(7.0 * i / n));
  });
}

void expectTreeOf(const TriangleMesh& mesh, const Obb4Tree& tree) {
  EXPECT_EQ(test::treeFault(tree), std::nullopt);
  ASSERT_EQ(tree.triangleCount(), mesh.triangles.size());
  for (std::uint32_t i = 0; i < tree.triangleCount(); ++i)
    for (int k = 0; k < 3; ++k) {
      const Vec3& p = mesh.corner(tree.meshTriangle(i), k);
      ASSERT_EQ(tree.corner(i, k), p);
      // These norms are rounded, and the radii of the tree are rounded up.
      ASSERT_LE((p - tree.origin()).stableNorm(), tree.radius() * (1 + 1e-15));
      ASSERT_LE(p.stableNorm(), tree.reach() * (1 + 1e-15));
      // In the tree of the tiniest mesh, coordinates are not in units of `length()`.
      if (tree.length() > 0x1p-900) {
        ASSERT_LE((p - tree.origin()).cwiseAbs().maxCoeff(), tree.length());
      }
    }
}

/// Expects that two trees are the same bit for bit.
void expectSameBytes(const Obb4Tree& a, const Obb4Tree& b) {
  ASSERT_EQ(a.nodes().size(), b.nodes().size());
  ASSERT_EQ(a.triangleCount(), b.triangleCount());
  const std::size_t bytes = a.nodes().size() * sizeof(Obb4Tree::Node);
  EXPECT_EQ(std::memcmp(a.nodes().data(), b.nodes().data(), bytes), 0);
  EXPECT_EQ(std::memcmp(&a.root(), &b.root(), sizeof(Obb1)), 0);
  for (std::uint32_t i = 0; i < a.triangleCount(); ++i)
    for (int k = 0; k < 3; ++k) ASSERT_EQ(a.corner(i, k), b.corner(i, k)) << i;
  EXPECT_EQ(a.origin(), b.origin());
  EXPECT_EQ(a.length(), b.length());
  EXPECT_EQ(a.radius(), b.radius());
  EXPECT_EQ(a.reach(), b.reach());
}

TEST(Obb4Refit, ContainsTheMovedTrianglesInRationals) {
  std::mt19937_64 random(test::testSeed(31));
  for (const TriangleMesh& mesh : {test::soup(random, 60, 0.3), bentSheet(6)}) {
    Obb4Tree tree(mesh);
    for (const Deformation& by : deformations(random)) {
      SCOPED_TRACE(by.name);
      const TriangleMesh target = moved(mesh, by);
      tree.refit(target);
      expectTreeOf(target, tree);
    }
    Obb4Tree few(TriangleMesh{mesh.vertices, {mesh.triangles[0]}});
    few.refit({mesh.vertices, {mesh.triangles[5]}});
    expectTreeOf({mesh.vertices, {mesh.triangles[5]}}, few);
  }
}

#ifdef __SSE2__
/// Refits while the processor flushes underflow to zero, and reads denormals as zero.
TEST(Obb4Refit, ContainsTheMovedTrianglesUnderFlushToZero) {
  std::mt19937_64 random(test::testSeed(32));
  const TriangleMesh mesh = test::soup(random, 60, 0.3);
  for (const int exponent : {0, -1005, -1015, -1030}) {
    TriangleMesh target = mesh;
    for (Vec3& v : target.vertices)
      v = v.unaryExpr([&](double x) { return std::ldexp(x, exponent); });
    Obb4Tree tree(mesh);
    const unsigned before = _mm_getcsr();
    _mm_setcsr(before | 0x8040);
    tree.refit(target);
    _mm_setcsr(before);
    EXPECT_EQ(test::treeFault(tree), std::nullopt) << exponent;
  }
}
#endif

/// If a mesh returns to its original shape, the refitted tree must have the boxes of the original
/// tree, whatever happened in between. The sizes are compared to a relative accuracy of 2^-20,
/// because a box may list its axes in another order.
TEST(Obb4Refit, BoxesAreAsSmallAsTheirAxesAllow) {
  std::mt19937_64 random(test::testSeed(33));
  const TriangleMesh mesh = test::soup(random, 500, 0.1);
  for (const ObbFit fit : {ObbFit::triangles, ObbFit::vertices}) {
    const Obb4Tree built(mesh, fit);
    Obb4Tree tree = built;
    tree.refit(mesh);
    expectSameBytes(tree, built);
    for (const Deformation& by : deformations(random)) tree.refit(moved(mesh, by));
    tree.refit(mesh);
    EXPECT_EQ(tree.origin(), built.origin());
    EXPECT_EQ(tree.length(), built.length());
    for (std::size_t i = 0; i < built.nodes().size(); ++i)
      for (std::uint32_t lane = 0; lane < Obb4Tree::kWidth; ++lane) {
        if (built.nodes()[i].child[lane] == Obb4Tree::kNone) continue;
        ASSERT_EQ(tree.nodes()[i].child[lane], built.nodes()[i].child[lane]);
        for (int j = 0; j < 3; ++j)
          ASSERT_NEAR(tree.nodes()[i].half[j][lane], built.nodes()[i].half[j][lane], 0x1p-20);
      }
  }
}

TEST(Obb4Refit, TheSameForAnyInstructionSet) {
  const TriangleMesh mesh = bentSheet(40);
  std::mt19937_64 random(test::testSeed(34));
  const TriangleMesh target = moved(mesh, deformations(random)[1]);
  Obb4Tree best(mesh);
  best.refit(target);
  for (const std::int64_t simd : test::simdTargets()) {
    SCOPED_TRACE(hwy::TargetName(simd));
    Obb4Tree tree(mesh);
    hwy::SetSupportedTargetsForTest(simd);
    tree.refit(target);
    hwy::SetSupportedTargetsForTest(0);
    expectSameBytes(best, tree);
  }
}

/// Compares queries on refitted trees with queries on new trees, and with brute force, while both
/// bodies deform. The context and the last pair of triangles are those of earlier deformations.
TEST(Obb4Refit, QueriesGiveTheAnswersOfNewTrees) {
  std::mt19937_64 random(test::testSeed(35));
  const TriangleMesh first = test::soup(random, 80, 0.1), second = bentSheet(7);
  Obb4Tree a(first), b(second);
  QueryContext context;
  LastPair last;
  int hits = 0, queries = 0;
  for (int round = 0; round < 2; ++round)
    for (const Deformation& by : deformations(random)) {
      const bool large = by.name.starts_with("2^9");  // beyond 2^900 no distance is computed
      const TriangleMesh meshA = moved(first, by),
                         meshB = moved(second, {"", [&](const Vec3&p) {
                                                  return Vec3(by.map(p) +
                                                              0.1 * (by.map(p) - by.map(0.9 * p)));
                                                }});
      a.refit(meshA);
      b.refit(meshB);
      const Obb4Tree newA(meshA), newB(meshB);
      for (int i = 0; i < 6; ++i) {
        Transform X = test::anyPose(random, 0);
        const double size = std::max(a.length(), b.length());
        for (int k = 0; k < 3; ++k)
          X.t[k] = (a.origin() - X.m * b.origin())[k] +
                   0.8 * size * std::uniform_real_distribution(-1.0, 1.0)(random);
        SCOPED_TRACE(by.name + " " + std::to_string(i));
        const bool touch = test::bruteForceTouch(meshA, {}, meshB, X);
        ASSERT_EQ(interference(Posed(a), Posed(b, X), context).has_value(), touch);
        ASSERT_EQ(interference(Posed(a), Posed(b, X), context, &last).has_value(), touch);
        ASSERT_EQ(interference(Posed(newA), Posed(newB, X), context).has_value(), touch);
        hits += touch;
        ++queries;
        if (large) continue;
        const double now = distance(Posed(a), Posed(b, X), {}, context).distance,
                     anew = distance(Posed(newA), Posed(newB, X), {}, context).distance;
        ASSERT_EQ(now == 0, touch);
        // Each error is at most 1e-12·d + 4·2^-53·S; S is below 8·(size + reach) here.
        const double S = 8 * (size + a.reach() + b.reach() + X.t.norm());
        ASSERT_LE(std::abs(now - anew), 2e-12 * anew + 8 * 0x1p-53 * S);
      }
    }
  EXPECT_GT(hits, queries / 10);
  EXPECT_LT(hits, queries * 9 / 10);
}

/// The moved mesh may have its vertices in another order.
TEST(Obb4Refit, OnlyTheTrianglesCount) {
  const TriangleMesh mesh = bentSheet(5);
  TriangleMesh apart;  // each triangle has vertices of its own, and one vertex is unused
  apart.vertices.emplace_back(1e6, 0, 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    test::add(apart, mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2));
  Obb4Tree tree(mesh);
  const Obb4Tree before = tree;
  tree.refit(apart);
  expectSameBytes(tree, before);
  EXPECT_EQ(test::treeFault(tree), std::nullopt);
}

TEST(Obb4Refit, RefusesAnotherMeshAndStaysAsItWas) {
  const TriangleMesh mesh = bentSheet(3);
  Obb4Tree tree(mesh);
  const Obb4Tree before = tree;
  TriangleMesh fewer = mesh, broken = mesh, wrong = mesh;
  fewer.triangles.pop_back();
  broken.vertices[7].y() = NAN;
  wrong.triangles[3][1] = 1000;
  try {
    tree.refit(fewer);
    ADD_FAILURE();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(
        error.what(),
        "a tree can only be refitted to a mesh of the same number of triangles: 18, not 17");
  }
  EXPECT_THROW(tree.refit(broken), std::invalid_argument);
  EXPECT_THROW(tree.refit(wrong), std::invalid_argument);
  expectSameBytes(tree, before);
  Obb4Tree ball(placed(Sphere{1}, {}));
  EXPECT_THROW(ball.refit(mesh), std::invalid_argument);
}

}  // namespace
}  // namespace corridor
