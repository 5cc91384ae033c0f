#include <iostream>
#include <random>

#include <gtest/gtest.h>

#include "collision/convex/convex_distance.h"
#include "collision/core/rounding.h"
#include "collision/hierarchy/obb4_tree.h"
#include "collision/queries/distance.h"
#include "collision/queries/distance_obb4.h"
#include "collision/queries/interference.h"
#include "collision/queries/interference_obb4.h"
#include "tests/collision/hierarchy/volumes.h"
#include "tests/collision/queries/every_target.h"
#include "tests/support/soups.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::anyPose;
using test::kParams;

/// The leaf primitives of a tree as convex sets, in the order of the mesh's triangles or of the
/// list of parts.
struct Items {
  std::vector<Triangle> triangles;
  std::vector<ConvexPart> parts;

  explicit Items(const TriangleMesh& mesh) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      triangles.push_back({mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)});
  }
  explicit Items(const std::vector<ConvexPart>& all) : parts(all) {}

  std::size_t size() const { return std::max(triangles.size(), parts.size()); }
  ConvexSet set(std::size_t i) const {
    return parts.empty() ? ConvexSet(triangles[i]) : ConvexSet(parts[i]);
  }
};

double reachOf(const Items& items, const Transform& X) {
  double reach = 0;
  for (std::size_t i = 0; i < items.size(); ++i)
    reach = std::max(reach, PosedSet(items.set(i), X).reach());
  return reach + X.t.norm();
}

template <class Volume>
class PartsDistance : public testing::Test {};
TYPED_TEST_SUITE(PartsDistance, test::Volumes, test::VolumeNames);

/// Compares every query on two trees with brute force over all pairs of their leaf primitives: the
/// distance and its witness points, the leaf primitives reported, both orders, contact, the
/// tolerance query, and the error that the options allow.
template <class Tree>
Distance checked(const Tree& a, const Items& itemsA, const Transform& X_WA, const Tree& b,
                 const Items& itemsB, const Transform& X_WB) {
  QueryContext context;
  const bool touch = interference(Posed(a, X_WA), Posed(b, X_WB), context).has_value();
  const Distance d = distance(Posed(a, X_WA), Posed(b, X_WB), {}, context),
                 back = distance(Posed(b, X_WB), Posed(a, X_WA), {}, context);
  EXPECT_EQ(d.distance == 0, touch);
  EXPECT_EQ(back.distance == 0, touch);
  double truth = HUGE_VAL;
  for (std::size_t i = 0; i < itemsA.size(); ++i)
    for (std::size_t k = 0; k < itemsB.size(); ++k)
      truth =
          std::min(truth, convexDistance({itemsA.set(i), X_WA}, {itemsB.set(k), X_WB}).distance);
  const double size = reachOf(itemsA, X_WA) + reachOf(itemsB, X_WB),
               allowed = 1e-12 * truth + 4 * kUnit * size;
  const ConvexPart p{{d.p_WA}, 0, false}, q{{d.p_WB}, 0, false};
  const double surface = (touch ? 0x1p-44 : 16 * kUnit) * size;
  EXPECT_LE(convexDistance({itemsA.set(d.a), X_WA}, {p, {}}).distance, surface);
  EXPECT_LE(convexDistance({itemsB.set(d.b), X_WB}, {q, {}}).distance, surface);
  EXPECT_NEAR((d.p_WA - d.p_WB).norm(), d.distance, 4 * kUnit * size);
  EXPECT_EQ(closerThan(Posed(a, X_WA), Posed(b, X_WB), 0, context), touch);
  if (touch) {
    EXPECT_EQ(truth, 0);
    EXPECT_TRUE(closerThan(Posed(a, X_WA), Posed(b, X_WB), 1e-9, context));
    return d;
  }
  EXPECT_NEAR(d.distance, truth, allowed);
  EXPECT_NEAR(back.distance, truth, allowed);
  EXPECT_TRUE(closerThan(Posed(a, X_WA), Posed(b, X_WB), d.distance + allowed, context));
  if (d.distance > 4 * allowed) {
    EXPECT_FALSE(closerThan(Posed(a, X_WA), Posed(b, X_WB), d.distance - 2 * allowed, context));
    EXPECT_FALSE(closerThan(Posed(b, X_WB), Posed(a, X_WA), d.distance / 2, context));
  }
  const Distance lax = distance(Posed(a, X_WA), Posed(b, X_WB), {0.1, 0.01}, context);
  EXPECT_GE(lax.distance, truth - allowed);
  EXPECT_LE(lax.distance, 1.1 * truth + 0.01 + allowed);
  return d;
}

/// Compares trees of random parts and meshes with brute force.
/// @param treeOf makes a tree of a mesh, or of a list of parts.
template <class TreeOf>
void compareWithBruteForce(const TreeOf& treeOf) {
  std::mt19937_64 random(test::testSeed(41));
  int touching = 0, apart = 0;
  for (int n = 0; n < 120; ++n) {
    SCOPED_TRACE(n);
    const TreeParams& params = kParams[n % std::size(kParams)];
    const TriangleMesh mesh = test::soup(random, 12, 0.1);
    const std::vector<ConvexPart> few = test::parts(random, 1 + n % 7, 0.15),
                                  single = {test::parts(random, 5, 0.3)[n % 5]};
    const bool meshFirst = n % 3 == 0;
    const Items itemsA = meshFirst ? Items(mesh) : Items(few), itemsB(n % 2 ? few : single);
    const auto a = meshFirst ? treeOf(mesh, params) : treeOf(few, params),
               b = treeOf(n % 2 ? few : single, params);
    const Transform X_WA = anyPose(random, n % 4 ? 1 : 1e3);
    Transform X_WB{anyPose(random, 1).m, X_WA.t + anyPose(random, n % 5 ? 0.8 : 0.1).t};
    for (int closer = 0; closer < 2; ++closer) {
      const Distance d = checked(a, itemsA, X_WA, b, itemsB, X_WB);
      (d.distance == 0 ? touching : apart)++;
      if (d.distance == 0) break;
      X_WB.t += (d.p_WA - d.p_WB) * (1 - std::pow(10.0, -n % 16));
    }
  }
  EXPECT_GT(touching, 4);
  EXPECT_GT(apart, 100);
}

TYPED_TEST(PartsDistance, AgreesWithBruteForceAndIsSymmetric) {
  using Tree = VolumeTree<TypeParam>;
  compareWithBruteForce([](const auto& items, const TreeParams& params) {
    if constexpr (requires { items.triangles; })
      return Tree(items, params);
    else
      return items.size() == 1 ? Tree(items[0]) : Tree(items, params);
  });
}

class Obb4PartsDistance : public test::EveryTarget {};
INSTANTIATE_TEST_SUITE_P(Simd, Obb4PartsDistance, testing::ValuesIn(test::simdTargets()),
                         test::targetName);

TEST_P(Obb4PartsDistance, AgreesWithBruteForceAndIsSymmetric) {
  compareWithBruteForce([](const auto& items, const TreeParams&) {
    if constexpr (requires { items.triangles; })
      return Obb4Tree(items);
    else
      return Obb4Tree(std::make_shared<const std::vector<ConvexPart>>(items));
  });
}

/// For bodies of many parts and triangles, 4-wide trees must find the same distances as binary
/// trees, and must test few pairs of parts and triangles.
TEST_P(Obb4PartsDistance, EqualsThatOfBinaryTrees) {
  std::mt19937_64 random(test::testSeed(2502));
  const TriangleMesh mesh = test::soup(random, 3000, 0.02);
  const auto parts =
      std::make_shared<const std::vector<ConvexPart>>(test::parts(random, 400, 0.05));
  const Obb4Tree a(mesh), b(parts);
  const VolumeTree<Obb> binaryA(mesh), binaryB(*parts);
  std::uint64_t tests = 0;
  int queries = 0;
  for (int n = 0; n < 60; ++n) {
    const Transform X_WA = anyPose(random, 1);
    const Transform X_WB{anyPose(random, 1).m, X_WA.t + anyPose(random, 3).t};
    QueryContext one, other;
    const double wide = distance(Posed(a, X_WA), Posed(b, X_WB), {}, one).distance,
                 binary = distance(Posed(binaryA, X_WA), Posed(binaryB, X_WB), {}, other).distance;
    const double allowed = 1e-12 * binary + 4 * kUnit * 20;
    EXPECT_NEAR(wide, binary, 2 * allowed);
    EXPECT_EQ(wide == 0, binary == 0);
    for (const double share : {0.5, 0.99, 1.01, 2.0}) {
      if (binary == 0) break;
      EXPECT_EQ(closerThan(Posed(a, X_WA), Posed(b, X_WB), share * binary, one), share > 1);
    }
    if (binary == 0) continue;
    ++queries;
    QueryContext count;
    distance(Posed(a, X_WA), Posed(b, X_WB), {}, count);
    tests += count.counters.primitiveTests;
  }
  ASSERT_GT(queries, 20);
  EXPECT_LT(tests / static_cast<std::uint64_t>(queries), 3000);  // of 1.2 million pairs
}

TriangleMesh boxMesh(const Vec3& size) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.push_back(
        0.5 * size.cwiseProduct(Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

/// Compares boxes as convex parts with boxes as meshes of twelve triangles, whose distances are
/// computed by other code. Gaps range from large ones to the last digits.
TEST(DistanceOfParts, BoxesAsMeshes) {
  std::mt19937_64 random(test::testSeed(42));
  std::uniform_real_distribution<double> real(0.05, 1);
  int apart = 0;
  for (int n = 0; n < 400; ++n) {
    const Vec3 sizeA(real(random), real(random), real(random)),
        sizeB(real(random), real(random), real(random));
    const ObbTree meshA(boxMesh(sizeA)), meshB(boxMesh(sizeB));
    const ObbTree a(placed(Box{sizeA}, {})), b(placed(Box{sizeB}, {}));
    const Transform X_WA = anyPose(random, 0.5);
    Transform X_WB = anyPose(random, 1);
    if (n % 2) X_WB.m = X_WA.m;
    QueryContext context;
    Distance truth = distance(Posed(meshA, X_WA), Posed(meshB, X_WB), {}, context);
    // A box inside another box touches it if both are solids, but not if they are surfaces.
    if (truth.distance == 0 || interference(Posed(a, X_WA), Posed(b, X_WB), context)) continue;
    for (int round = 0; round < 2; ++round) {
      for (const auto& [s, t] : {std::pair(&a, &b), std::pair(&a, &meshB), std::pair(&meshA, &b)}) {
        const double found = distance(Posed(*s, X_WA), Posed(*t, X_WB), {}, context).distance;
        const double size = X_WA.t.norm() + X_WB.t.norm() + sizeA.norm() + sizeB.norm();
        EXPECT_NEAR(found, truth.distance, 2e-12 * truth.distance + 8 * kUnit * size) << n;
        ++apart;
      }
      // Before the second round, the bodies are moved close to contact.
      const Vec3 way = truth.p_WA - truth.p_WB;
      X_WB.t += way * (1 - std::pow(10.0, -1 - n % 11));
      truth = distance(Posed(meshA, X_WA), Posed(meshB, X_WB), {}, context);
      if (truth.distance == 0) break;
    }
  }
  EXPECT_GT(apart, 1'000);
}

/// A mesh of many triangles against one convex part: the query must prune most of the tree.
TEST(DistanceOfParts, TestsFewTriangles) {
  std::mt19937_64 random(test::testSeed(43));
  const TriangleMesh mesh = test::soup(random, 3'000, 0.02);
  const ObbTree a(mesh);
  QueryContext context;
  int queries = 0;
  for (const ConvexPart& part : test::parts(random, 10, 0.2)) {
    const ObbTree b(part);
    const Transform X_WB{anyPose(random, 1).m, Vec3(1.5, 0.5, 0) + anyPose(random, 0.5).t};
    distance(Posed(a), Posed(b, X_WB), {}, context);
    closerThan(Posed(a), Posed(b, X_WB), 0.01, context);
    queries += 2;
  }
  std::cout << context.counters.primitiveTests / queries << " of " << mesh.triangles.size()
            << " triangles tested per query\n";
  EXPECT_LT(context.counters.primitiveTests / queries, mesh.triangles.size() / 10);
}

}  // namespace
}  // namespace corridor
