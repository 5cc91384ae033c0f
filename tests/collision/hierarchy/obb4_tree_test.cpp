#include "collision/hierarchy/obb4_tree.h"

#include <cmath>
#include <cstring>
#include <random>

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "tests/collision/queries/every_target.h"
#include "tests/support/meshes.h"
#include "tests/support/soups.h"
#include "tests/support/support.h"
#include "tests/support/tree_fault.h"
#include "tests/support/workload.h"

namespace corridor {
namespace {

using test::add;

TEST(Obb4Tree, ContainsItsTrianglesInRationals) {
  std::mt19937_64 random(test::testSeed(21));
  for (const double offset : {0.0, 1e6, 1e12})
    for (const int exponent : {0, -20, -1040, -500, 300, 900}) {
      TriangleMesh mesh = test::soup(random, 100, 0.3);
      for (Vec3& v : mesh.vertices)
        v = (v + Vec3(offset, 0, -offset)).unaryExpr([&](double x) {
          return std::ldexp(x, exponent);
        });
      EXPECT_EQ(test::treeFault(Obb4Tree(mesh)), std::nullopt) << offset << " 2^" << exponent;
    }
}

#ifdef __SSE2__
/// Builds trees while the processor flushes underflow to zero, and reads denormals as zero. Boxes
/// must contain the triangles nevertheless.
TEST(Obb4Tree, ContainsTrianglesUnderFlushToZero) {
  std::mt19937_64 random(test::testSeed(23));
  for (const int exponent : {-1005, -1015, -1030}) {
    TriangleMesh mesh = test::soup(random, 100, 0.3);
    for (Vec3& v : mesh.vertices)
      v = v.unaryExpr([&](double x) { return std::ldexp(x, exponent); });
    const unsigned before = _mm_getcsr();
    _mm_setcsr(before | 0x8040);
    const Obb4Tree tree(mesh);
    _mm_setcsr(before);
    EXPECT_EQ(test::treeFault(tree), std::nullopt) << exponent;
  }
}
#endif

TEST(Obb4Tree, ContainsItsConvexPartInRationals) {
  std::mt19937_64 random(test::testSeed(24));
  const auto real = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  const auto vector = [&] { return Vec3(real(-1, 1), real(-1, 1), real(-1, 1)); };
  for (int n = 0; n < 30; ++n) {
    const double size = std::exp2(n % 7 == 0 ? real(-300, 300) : real(-20, 20));
    const double a = size * std::exp2(real(-20, 0)), b = size * std::exp2(real(-20, 0));
    Convex hull;
    for (int i = 0; i < 1 + n % 9; ++i) hull.points.push_back(size * vector());
    const Primitive primitives[] = {Box{Vec3(a, b, size)}, Sphere{a}, Capsule{a, b}, Cylinder{a, b},
                                    hull};
    const Transform X{Eigen::AngleAxisd(real(0, 3), vector().normalized()).toRotationMatrix(),
                      10 * size * vector()};
    for (const Primitive& primitive : primitives) {
      const Obb4Tree tree(placed(primitive, n % 3 ? X : Transform()));
      ASSERT_EQ(test::treeFault(tree), std::nullopt) << nameOf(primitive) << ' ' << n;
      ASSERT_TRUE(tree.hasParts());
      const ConvexPart& part = tree.part(0);
      for (const Vec3& p : part.points) {
        // The rim of a disc is farther from the origin than the end of the cylinder's axis, but by
        // less than the radius. So the radius is left out for flat ends.
        const double ball = part.flatEnds ? 0 : part.radius;
        ASSERT_LE((p - tree.origin()).norm() + ball, tree.radius() * (1 + 1e-15));
        ASSERT_LE(p.norm() + ball, tree.reach() * (1 + 1e-15));
      }
    }
  }
}

TEST(Obb4Tree, SharedMeshes) {
  const auto data = test::dataFolder();
  if (!data) GTEST_SKIP() << "set CORRIDOR_DATA to the folder of shared test data";
  for (const char* name : {"pqp_torus", "slivers_A", "soup_far_A", "soup_tiny_B",
                           "touching_boxes_B", "panda_hand", "box"}) {
    const Obb4Tree tree(
        test::plainObj(*data / "collision" / "meshes" / (std::string(name) + ".obj")));
    EXPECT_EQ(test::treeFault(tree), std::nullopt) << name;
  }
}

TEST(Obb4Tree, FewAndDegenerateTriangles) {
  for (int n = 1; n < 20; ++n) {
    TriangleMesh point, segment, same;
    for (int i = 0; i < n; ++i) {
      add(point, Vec3(1, 2, 3), Vec3(1, 2, 3), Vec3(1, 2, 3));
      add(segment, Vec3(0, 0, 0), Vec3(3, 4, 0), Vec3(3, 4, 0));
      add(same, Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0));
    }
    for (const TriangleMesh* mesh : {&point, &segment, &same}) {
      const Obb4Tree tree(*mesh);
      EXPECT_EQ(test::treeFault(tree), std::nullopt) << n;
      EXPECT_EQ(tree.triangleCount(), static_cast<std::size_t>(n));
    }
  }
}

/// Triangles of size 2^-i around a point make a very deep tree. Ten thousand equal triangles cannot
/// be divided into two groups by position.
TEST(Obb4Tree, DeepAndIndivisible) {
  TriangleMesh deep, same;
  for (int i = 0; i < 1'000; ++i) {
    const double s = std::ldexp(1.0, -i);
    add(deep, Vec3(s, 0, 0), Vec3(s, s / 4, 0), Vec3(s, 0, s / 4));
  }
  EXPECT_EQ(test::treeFault(Obb4Tree(deep)), std::nullopt);
  same.vertices = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  same.triangles.assign(10'000, {0, 1, 2});
  const Obb4Tree tree(same);
  EXPECT_LT(tree.bytes(), 10'000U * 80);
}

/// Returns a wavy sheet of 2n² triangles.
TriangleMesh sheet(std::uint32_t n) {
  return test::sheet(n, [](std::uint32_t i, std::uint32_t k) {
    return Vec3(i, k, 5 * std::sin(0.1 * i) * std::cos(0.07 * k));
  });
}

/// Tests the bound of the memory that collision/hierarchy/MEASURED.md derives for meshes with
/// shared vertices.
TEST(Obb4Tree, SmoothMeshesTakeEightyBytesATriangle) {
  const TriangleMesh mesh = sheet(120);
  const Obb4Tree tree(mesh);
  EXPECT_LE(tree.bytes(), 80 * mesh.triangles.size());
}

/// Expects that two trees are the same bit for bit.
void expectSame(const Obb4Tree& a, const Obb4Tree& b) {
  ASSERT_EQ(a.nodes().size(), b.nodes().size());
  ASSERT_EQ(a.triangleCount(), b.triangleCount());
  static_assert(sizeof(Obb4Tree::Node) == 64 * sizeof(float), "no padding");
  EXPECT_EQ(
      std::memcmp(a.nodes().data(), b.nodes().data(), a.nodes().size() * sizeof(Obb4Tree::Node)),
      0);
  for (std::uint32_t i = 0; i < a.triangleCount(); ++i)
    ASSERT_EQ(a.meshTriangle(i), b.meshTriangle(i)) << i;
  EXPECT_EQ(a.origin(), b.origin());
  EXPECT_EQ(a.length(), b.length());
  EXPECT_EQ(a.radius(), b.radius());
  EXPECT_EQ(a.reach(), b.reach());
}

/// Returns meshes that are so large that several threads build parts of their trees. The triangles
/// of the second mesh are in random order.
std::vector<TriangleMesh> largeMeshes() {
  std::mt19937_64 random(test::testSeed(22));
  return {sheet(100), test::soup(random, 20'000, 0.1)};
}

TEST(Obb4Tree, TheSameForAnyNumberOfThreads) {
  for (const TriangleMesh& mesh : largeMeshes())
    for (const ObbFit fit : {ObbFit::triangles, ObbFit::vertices}) {
      const Obb4Tree one(mesh, fit);
      for (const unsigned threads : {0U, 2U, 3U, 8U}) {
        SCOPED_TRACE(threads);
        expectSame(one, Obb4Tree(mesh, fit, threads));
      }
    }
}

TEST(Obb4Tree, TheSameForAnyInstructionSet) {
  for (const TriangleMesh& mesh : largeMeshes()) {
    const Obb4Tree best(mesh);
    for (const std::int64_t target : test::simdTargets()) {
      SCOPED_TRACE(hwy::TargetName(target));
      hwy::SetSupportedTargetsForTest(target);
      const Obb4Tree tree(mesh);
      hwy::SetSupportedTargetsForTest(0);
      expectSame(best, tree);
    }
  }
}

TEST(Obb4Tree, NeedsATriangle) {
  EXPECT_THROW(Obb4Tree(TriangleMesh{}), std::invalid_argument);
  EXPECT_THROW(Obb4Tree(TriangleMesh{{Vec3::Zero()}, {}}), std::invalid_argument);
  EXPECT_THROW(Obb4Tree(TriangleMesh{{Vec3::Zero()}, {{0, 0, 1}}}), std::invalid_argument);
  EXPECT_THROW(Obb4Tree(TriangleMesh{{Vec3(0, NAN, 0)}, {{0, 0, 0}}}), std::invalid_argument);
}

TEST(Obb4Tree, CheckFindsWhatIsWrong) {
  // No public function makes a box that is smaller than its content, so the test changes the tree's
  // memory.
  TriangleMesh mesh;
  add(mesh, Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0));
  Obb4Tree tree(mesh);
  EXPECT_EQ(test::treeFault(tree), std::nullopt);
  const_cast<Obb4Tree::Node&>(tree.nodes()[0]).half[1][0] *= 0.99F;  // NOLINT
  EXPECT_EQ(test::treeFault(tree), "a box above does not contain triangle 0");

  Obb4Tree other(mesh);
  const_cast<Obb1&>(other.root()).half[1] *= 0.99F;  // NOLINT
  EXPECT_EQ(test::treeFault(other), "a box above does not contain triangle 0");
}

}  // namespace
}  // namespace corridor
