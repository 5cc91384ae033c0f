// Tests that trees and hulls from a cache are those that are computed.
#include "collision/hierarchy/cached_tree.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "collision/hierarchy/body.h"
#include "tests/support/meshes.h"
#include "tests/support/support.h"
#include "tests/support/tree_fault.h"

namespace corridor::test {
namespace {

class CachedTree : public testing::Test {
 protected:
  ~CachedTree() override { std::filesystem::remove_all(folder_); }

  FileCache cache() const { return FileCache(folder_ / "cache", "code"); }

  /// Expects that the trees are the same bit for bit.
  static void expectEqual(const Obb4Tree& a, const Obb4Tree& b) {
    ASSERT_EQ(a.nodes().size(), b.nodes().size());
    EXPECT_EQ(
        std::memcmp(a.nodes().data(), b.nodes().data(), a.nodes().size() * sizeof(Obb4Tree::Node)),
        0);
    EXPECT_EQ(std::memcmp(&a.root(), &b.root(), sizeof(a.root())), 0);
    ASSERT_EQ(a.itemCount(), b.itemCount());
    for (std::uint32_t i = 0; i < a.itemCount(); ++i) {
      EXPECT_EQ(a.meshTriangle(i), b.meshTriangle(i));
      EXPECT_EQ(a.triangle(i), b.triangle(i));
    }
    EXPECT_EQ(a.origin(), b.origin());
    EXPECT_EQ(a.length(), b.length());
    EXPECT_EQ(a.radius(), b.radius());
    EXPECT_EQ(a.reach(), b.reach());
  }

  std::filesystem::path folder_ = newFolder();
  TriangleMesh cube_ = tessellatedCube(12);
};

TEST_F(CachedTree, EqualsTheTreeThatIsBuilt) {
  for (const ObbFit fit : {ObbFit::triangles, ObbFit::hull}) {
    const Obb4Tree built(cube_, fit);
    FileCache first = cache();
    expectEqual(*cachedTree(cube_, fit, &first), built);
    EXPECT_EQ(first.counts().missed, 1u);
    first.save();
    FileCache second = cache();
    const auto found = cachedTree(cube_, fit, &second);
    EXPECT_EQ(second.counts().found, 1u);
    expectEqual(*found, built);
    EXPECT_EQ(treeFault(*found), std::nullopt);
  }
}

TEST_F(CachedTree, AnotherMeshHasAnotherTree) {
  FileCache kept = cache();
  cachedTree(cube_, ObbFit::triangles, &kept);
  kept.save();
  TriangleMesh moved = cube_;
  moved.vertices[7].y() = std::nextafter(moved.vertices[7].y(), 2);
  TriangleMesh turned = cube_;
  std::swap(turned.triangles[5][1], turned.triangles[5][2]);
  for (const TriangleMesh& other : {moved, turned})
    expectEqual(*cachedTree(other, ObbFit::triangles, &kept), Obb4Tree(other));
  EXPECT_EQ(kept.counts().found, 0u);
}

TEST_F(CachedTree, HasTheHullThatIsComputedWithFewerPoints) {
  const TriangleMesh folded = sheet(30, [](std::uint32_t i, std::uint32_t k) {
    return Vec3(i, k, i % 2 == 0 ? 0 : 40);  // deep folds: no hull fits
  });
  for (const TriangleMesh& mesh : {cube_, tessellatedCube(40), folded}) {
    const auto built = enclosingHull(mesh);
    for (const bool isFound : {false, true}) {
      FileCache kept = cache();
      const auto hull = cachedHull(mesh, &kept);
      EXPECT_EQ(kept.counts().found, isFound ? 1u : 0u);
      kept.save();
      ASSERT_EQ(hull.has_value(), built.has_value());
      if (!hull) continue;
      const EnclosingHull expected = isFound ? thinned(*built) : *built;
      EXPECT_EQ(hull->radius, expected.radius);
      EXPECT_TRUE(std::ranges::equal(hull->points.points(), expected.points.points()));
      EXPECT_EQ(hull->points.points().size() < 200, isFound) << "a hull from the cache is thinned";
    }
  }
  EXPECT_FALSE(enclosingHull(folded)) << "the test is also about meshes without a hull";
}

TEST_F(CachedTree, ABodyAsksTheCacheOnceAndOnlyForWhatIsNeeded) {
  const auto mesh = std::make_shared<const TriangleMesh>(cube_);
  for (const bool isFound : {false, true}) {
    const auto kept = std::make_shared<FileCache>(folder_ / "cache", "code");
    const Body body("cube", mesh, false, {}, kept);
    EXPECT_EQ(kept->counts().found + kept->counts().missed, 0u);
    body.tree();
    body.renamed("other").tree();
    body.hull();
    EXPECT_EQ(kept->counts().found, isFound ? 2u : 0u);
    EXPECT_EQ(kept->counts().missed, isFound ? 0u : 2u);
    kept->save();
  }
}

TEST_F(CachedTree, SmallMeshesAreNotKept) {
  FileCache kept = cache();
  const TriangleMesh small = tessellatedCube(2);
  expectEqual(*cachedTree(small, ObbFit::triangles, &kept), Obb4Tree(small));
  cachedHull(small, &kept);
  kept.save();
  EXPECT_EQ(kept.counts().written, 0u);
}

// Every answer comes from the tree or the hull that is computed, wherever a file is damaged.
TEST_F(CachedTree, DamagedFilesAreComputedAnew) {
  FileCache first = cache();
  const Obb4Tree built(cube_);
  cachedTree(cube_, ObbFit::triangles, &first);
  first.save();
  const auto file = std::filesystem::directory_iterator(folder_ / "cache")->path();
  const std::string bytes = contents(file);
  std::mt19937_64 random(testSeed(20261130));
  for (int i = 0; i < casesOf(200, 5000); ++i) {
    std::string damaged = bytes;
    char& byte = damaged[random() % damaged.size()];
    byte = static_cast<char>(static_cast<unsigned char>(byte) ^ (1 + random() % 255));
    std::ofstream(file, std::ios::binary) << damaged;
    FileCache kept = cache();
    const auto tree = cachedTree(cube_, ObbFit::triangles, &kept);
    EXPECT_EQ(kept.counts().damaged, 1u);
    if (i < 5) expectEqual(*tree, built);
  }
}

}  // namespace
}  // namespace corridor::test
