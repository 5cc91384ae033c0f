// Tests of fronts: along motions with steps of any length, verdicts must be those of queries
// without a front.
#include "collision/course/front.h"

#include <cmath>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "collision/queries/interference.h"
#include "collision/volumes/pair_tests.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

/// Returns a closed surface with bumps.
TriangleMesh bumpy(std::uint32_t rows, double bump) {
  const std::uint32_t columns = 2 * rows;
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < columns; ++i)
    for (std::uint32_t j = 0; j <= rows; ++j) {
      const double u = 2 * M_PI * i / columns, v = M_PI * j / rows;
      const double r = 1 + bump * std::sin(5 * u) * std::sin(6 * v);
      mesh.vertices.push_back(
          r * Vec3(std::cos(u) * std::sin(v), std::sin(u) * std::sin(v), std::cos(v)));
    }
  for (std::uint32_t i = 0; i < columns; ++i)
    for (std::uint32_t j = 0; j < rows; ++j) {
      const std::uint32_t p = i * (rows + 1) + j, q = (i + 1) % columns * (rows + 1) + j;
      if (j > 0) mesh.triangles.push_back({p, q, q + 1});
      if (j + 1 < rows) mesh.triangles.push_back({p, q + 1, p + 1});
    }
  return mesh;
}

struct Work {
  int contacts = 0, queries = 0;
  std::uint64_t warm = 0, cold = 0;  ///< box tests with a front and without a front
};

/// Moves b by random steps of the given size about a place where the surfaces nearly touch.
template <class Volume>
Work walk(double step, int steps, std::mt19937_64& random, double scale = 1) {
  std::normal_distribution<double> normal;
  const auto vector = [&] { return Vec3(normal(random), normal(random), normal(random)); };
  TriangleMesh meshA = bumpy(12, 0.1), meshB = bumpy(10, 0.15);
  for (TriangleMesh* mesh : {&meshA, &meshB})
    for (Vec3& v : mesh->vertices) v *= scale;
  const VolumeTree<Volume> a(meshA), b(meshB);
  QueryContext warm, cold;
  Front front;
  Work work;
  Transform X;
  X.t = scale * 2.1 * vector().normalized();
  for (int i = 0; i < steps; ++i) {
    X.m = Eigen::AngleAxisd(step * normal(random), vector().normalized()).toRotationMatrix() * X.m;
    X.t += scale * step * vector();
    if (X.t.norm() > 2.4 * scale) X.t *= 0.9;
    const bool expected = interference(Posed(a), Posed(b, X), cold).has_value();
    const auto found = interference(a, Posed(b, X), front, warm);
    EXPECT_EQ(found.has_value(), expected) << step << ", " << i;
    work.contacts += expected;
    ++work.queries;
  }
  work.warm = warm.counters.boxTests;
  work.cold = cold.counters.boxTests;
  return work;
}

template <class Volume>
class Fronts : public testing::Test {};
using Volumes = testing::Types<Obb, Rss>;
TYPED_TEST_SUITE(Fronts, Volumes);

TYPED_TEST(Fronts, VerdictsAreThoseOfQueriesWithoutAFront) {
  std::mt19937_64 random(test::testSeed(31));
  Work all;
  for (const double step : {0.0, 1e-9, 1e-4, 1e-3, 1e-2, 0.1, 1.0}) {
    const Work work = walk<TypeParam>(step, 150, random);
    all.contacts += work.contacts;
    all.queries += work.queries;
    if (step == 1e-4 && work.contacts == 0) {
      EXPECT_LT(10 * work.warm, work.cold);
    }
  }
  EXPECT_GT(all.contacts, all.queries / 10);
  EXPECT_LT(all.contacts, all.queries * 9 / 10);
}

/// If nothing touches, small steps must cost nearly no tests.
TYPED_TEST(Fronts, SmallStepsCostFewTests) {
  const VolumeTree<TypeParam> a(bumpy(16, 0.1)), b(bumpy(16, 0.1));
  QueryContext warm, cold;
  Front front;
  for (int i = 0; i < 1000; ++i) {
    const double angle = 1e-4 * i;
    Transform X;
    X.t = 2.25 * Vec3(std::cos(angle), std::sin(angle), 0.1);
    ASSERT_FALSE(interference(a, Posed(b, X), front, warm));
    interference(Posed(a), Posed(b, X), cold);
  }
  EXPECT_LT(20 * warm.counters.boxTests, cold.counters.boxTests);
  EXPECT_LT(front.size(), 4096u);
}

TYPED_TEST(Fronts, TinyAndHugeBodies) {
  std::mt19937_64 random(test::testSeed(32));
  for (const double scale : {0x1p-300, 0x1p300}) walk<TypeParam>(1e-3, 60, random, scale);
}

/// Maps need not be rigid, and a body may jump by any distance between two queries with one front.
TYPED_TEST(Fronts, MapsThatScaleAndJump) {
  std::mt19937_64 random(test::testSeed(33));
  std::uniform_real_distribution<double> real(-1, 1);
  // The meshes are small because, under maps that are not rigid, no pair of boxes is reported as
  // separated.
  const VolumeTree<TypeParam> a(bumpy(4, 0.1)), b(bumpy(3, 0.2));
  QueryContext context;
  Front front;
  int contacts = 0;
  for (int i = 0; i < 100; ++i) {
    Transform X;
    for (int k = 0; k < 9; ++k) X.m(k / 3, k % 3) += 0.05 * (i % 5) * real(random);
    X.t = Vec3(2.2 * real(random), 2.2 * real(random), 2.2 * real(random));
    const bool expected = interference(Posed(a), Posed(b, X), context).has_value();
    EXPECT_EQ(interference(a, Posed(b, X), front, context).has_value(), expected) << i;
    contacts += expected;
  }
  EXPECT_GT(contacts, 10);
  EXPECT_LT(contacts, 95);
}

TYPED_TEST(Fronts, ClearedFrontsServeOtherTrees) {
  const VolumeTree<TypeParam> a(bumpy(8, 0.1)), b(bumpy(6, 0.1)), c(bumpy(4, 0.2));
  QueryContext context;
  Front front;
  Transform X;
  X.t = Vec3(2.5, 0, 0);
  EXPECT_FALSE(interference(a, Posed(b, X), front, context));
  EXPECT_GT(front.size(), 0u);
  front.clear();
  EXPECT_EQ(front.size(), 0u);
  X.t = Vec3(1, 0, 0);
  EXPECT_TRUE(interference(b, Posed(c, X), front, context));
}

}  // namespace
}  // namespace corridor
