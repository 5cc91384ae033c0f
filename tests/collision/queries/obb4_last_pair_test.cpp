// Queries on 4-wide OBB trees start from a `LastPair`, the pair of triangles that decided the last
// query. The answers must not depend on this pair: a query that starts from the pair of another
// pose, tree or order must answer like a query that starts from no pair.
#include <cmath>
#include <deque>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "collision/core/rounding.h"
#include "collision/predicates/triangle_contact.h"
#include "collision/queries/distance_obb4.h"
#include "collision/queries/interference_obb4.h"
#include "tests/support/brute_force.h"
#include "tests/support/meshes.h"
#include "tests/support/reference_distance.h"
#include "tests/support/soups.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::anyPose;
using test::corners;
using test::errorScale;
using test::soup;

struct MeshAndTree {
  explicit MeshAndTree(const TriangleMesh& m) : mesh(m), tree(m) {}
  TriangleMesh mesh;
  Obb4Tree tree;
};

/// Runs every query on two bodies twice, starting from the pair `last` and starting from no pair,
/// and expects the same verdicts, and distances that agree within their errors. Returns whether the
/// bodies touch.
bool expectSame(const MeshAndTree& a, const Transform& X_WA, const MeshAndTree& b,
                const Transform& X_WB, QueryContext& context, LastPair& last,
                const std::string& where) {
  SCOPED_TRACE(where);
  const auto hit = interference(Posed(a.tree, X_WA), Posed(b.tree, X_WB), context),
             warm = interference(Posed(a.tree, X_WA), Posed(b.tree, X_WB), context, &last);
  EXPECT_EQ(warm.has_value(), hit.has_value());
  if (warm) {
    EXPECT_TRUE(
        trianglesTouchExact(corners(a.mesh, warm->a), X_WA, corners(b.mesh, warm->b), X_WB));
  }
  const Distance d = distance(Posed(a.tree, X_WA), Posed(b.tree, X_WB), {}, context),
                 e = distance(Posed(a.tree, X_WA), Posed(b.tree, X_WB), {}, context, &last);
  EXPECT_EQ(e.distance == 0, hit.has_value());
  const double size = std::max(errorScale(a.mesh, X_WA), errorScale(b.mesh, X_WB)),
               allowed = 2e-12 * d.distance + 8 * kUnit * size;
  EXPECT_NEAR(e.distance, d.distance, allowed);
  // The witness points must be on the reported triangles.
  EXPECT_LE(test::referenceDistance(e.p_WA, corners(a.mesh, e.a), X_WA), 4 * kUnit * size);
  EXPECT_LE(test::referenceDistance(e.p_WB, corners(b.mesh, e.b), X_WB), 4 * kUnit * size);
  const Distance loose =
      distance(Posed(a.tree, X_WA), Posed(b.tree, X_WB), {0.1, 0.001}, context, &last);
  EXPECT_GE(loose.distance, d.distance - allowed);
  EXPECT_LE(loose.distance, 1.1 * d.distance + 0.001 + allowed);
  for (const double tolerance : {0.0, 0.01, 0.999 * d.distance, d.distance, 1.001 * d.distance}) {
    EXPECT_EQ(closerThan(Posed(a.tree, X_WA), Posed(b.tree, X_WB), tolerance, context, &last),
              closerThan(Posed(a.tree, X_WA), Posed(b.tree, X_WB), tolerance, context))
        << tolerance;
  }
  return hit.has_value();
}

/// Bodies move in small steps, in and out of contact. Every pair of bodies is tested in both orders
/// with one context.
TEST(Obb4LastPair, MotionsOfManyBodies) {
  std::mt19937_64 random(test::testSeed(41));
  int touching = 0, cases = 0;
  for (int n = 0; n < 6; ++n) {
    std::deque<MeshAndTree> bodies;
    for (const int count : {1, 12, 60, 200}) bodies.emplace_back(soup(random, count, 0.15));
    std::vector<Transform> from, to;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      from.push_back(anyPose(random, 1.2));
      to.push_back(anyPose(random, 1.2));
    }
    QueryContext context;
    LastPair last[4][4];
    const int steps = (n % 2 ? 400 : 40) / test::kSlowdown;
    for (int k = 0; k <= 30 / test::kSlowdown; ++k) {
      std::vector<Transform> X;
      for (std::size_t i = 0; i < bodies.size(); ++i) {
        const double t = static_cast<double>(k) / steps;
        const Eigen::Quaterniond q(from[i].m), r(to[i].m);
        X.push_back({q.slerp(t, r).toRotationMatrix(), from[i].t + t * (to[i].t - from[i].t)});
      }
      for (std::size_t i = 0; i < bodies.size(); ++i)
        for (std::size_t j = 0; j < bodies.size(); ++j) {
          if (i == j) continue;
          touching += expectSame(bodies[i], X[i], bodies[j], X[j], context, last[i][j],
                                 "bodies " + std::to_string(i) + " " + std::to_string(j) +
                                     " step " + std::to_string(k));
          ++cases;
        }
    }
  }
  EXPECT_GT(touching, cases / 10);
  EXPECT_LT(touching, cases - cases / 10);
}

/// Returns a stack of slats, 0.1 apart. The triangles are in the order of the slats.
TriangleMesh slats(int count) {
  TriangleMesh mesh;
  for (int i = 0; i < count; ++i)
    test::addBox(mesh, Vec3(0, 0, 0.1 * i), Vec3(1, 1, 0.1 * i + 0.05));
  return mesh;
}

/// If one pair has decided two queries, the next query tests this pair first. So that query tests
/// no box, or far fewer boxes.
TEST(Obb4LastPair, DecidesTheNextQuery) {
  std::mt19937_64 random(test::testSeed(42));
  const MeshAndTree a(slats(40)), b(soup(random, 100, 0.1));
  Transform X;
  X.t = Vec3(0, 0, 2);
  QueryContext context;
  LastPair last;
  const auto boxTests = [&](auto&& ask) {
    context.counters = {};
    ask();
    return context.counters.boxTests;
  };
  const auto touch = [&] {
    EXPECT_TRUE(interference(Posed(a.tree), Posed(b.tree, X), context, &last));
  };
  const auto close = [&] {
    EXPECT_TRUE(closerThan(Posed(a.tree), Posed(b.tree, X), 0.01, context, &last));
  };
  const auto far = [&] {
    EXPECT_GT(distance(Posed(a.tree), Posed(b.tree, X), {}, context, &last).distance, 0);
  };
  EXPECT_GT(boxTests(touch), 0U);
  EXPECT_GT(boxTests(touch), 0U) << "a pair that decided one query is not used yet";
  EXPECT_EQ(boxTests(touch), 0U);
  EXPECT_EQ(boxTests(close), 0U);
  EXPECT_EQ(boxTests([&] { (void)distance(Posed(a.tree), Posed(b.tree, X), {}, context, &last); }),
            0U);
  X.t = Vec3(0, 0, 9);
  const auto cold = boxTests(far);
  EXPECT_LT(boxTests(far), cold);
}

/// For unrelated queries, the stored pair may cost at most a thousandth of the triangle tests.
TEST(Obb4LastPair, CostsLittleForUnrelatedQueries) {
  std::mt19937_64 random(test::testSeed(43));
  const MeshAndTree a(soup(random, 300, 0.1)), b(soup(random, 300, 0.1));
  QueryContext used, fresh;
  LastPair last;
  std::uint64_t more = 0, all = 0;
  for (int n = 0; n < 300; ++n) {
    const Transform X = anyPose(random, 0.7);
    used.counters = fresh.counters = {};
    (void)interference(Posed(a.tree), Posed(b.tree, X), used, &last);
    (void)interference(Posed(a.tree), Posed(b.tree, X), fresh);
    // A stored pair that does not decide the query costs one additional test of two triangles.
    more += used.counters.primitiveTests - fresh.counters.primitiveTests;
    all += fresh.counters.primitiveTests;
  }
  EXPECT_LE(1000 * more, all);
}

/// The stored pair may be from a query on other trees, which are smaller or elsewhere, and touch or
/// don't. The answer must be right nevertheless.
TEST(Obb4LastPair, OfOtherTrees) {
  std::mt19937_64 random(test::testSeed(44));
  TriangleMesh far = slats(1);
  for (Vec3& v : far.vertices) v += Vec3(0, 0, 50);
  const std::vector<MeshAndTree> bodies = {
      MeshAndTree(slats(60)), MeshAndTree(soup(random, 150, 0.2)), MeshAndTree(far),
      MeshAndTree(soup(random, 1, 0.3)), MeshAndTree(slats(2))};
  QueryContext context;
  LastPair last;
  const int count = test::casesOf(80, 200);
  for (int n = 0; n < count; ++n) {
    const auto pair = static_cast<std::size_t>(n) % (bodies.size() * bodies.size());
    const MeshAndTree &bodyA = bodies[pair / bodies.size()], &bodyB = bodies[pair % bodies.size()];
    const Obb4Tree &a = bodyA.tree, &b = bodyB.tree;
    Transform X = anyPose(random, 0.3);
    X.t.z() += n % 2 ? 3 : 0;
    const bool touch = test::bruteForceTouch(bodyA.mesh, {}, bodyB.mesh, X),
               close = test::bruteForceDistance(bodyA.mesh, {}, bodyB.mesh, X) <= 1e-3;
    for (int i = 0; i < 3; ++i) {  // repeated, so that the query uses the stored pair
      EXPECT_EQ(interference(Posed(a), Posed(b, X), context, &last).has_value(), touch) << n;
      EXPECT_EQ(closerThan(Posed(a), Posed(b, X), 1e-3, context, &last), close) << n;
      const Distance d = distance(Posed(a), Posed(b, X), {}, context, &last);
      EXPECT_EQ(d.distance == 0, touch) << n;
      EXPECT_LT(d.a, bodyA.mesh.triangles.size());
      EXPECT_LT(d.b, bodyB.mesh.triangles.size());
    }
  }
}

}  // namespace
}  // namespace corridor
