#include "collision/hierarchy/tree_kinds.h"

#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "collision/hierarchy/with_trees.h"
#include "tests/support/soups.h"
#include "tests/support/support.h"
#include "tests/support/tree_fault.h"

namespace corridor {
namespace {

std::string complaint(const TreeNames& words) {
  const auto wrong = invalidNameIn(words);
  return wrong ? wrong->key + ": " + wrong->text : "";
}

TEST(TreeKinds, EveryNameHasItsOwnKind) {
  std::set<TreeKind> kinds;
  for (const VolumeKind& volume : volumeKinds())
    for (const std::string& overlap : volume.overlaps)
      for (const std::string& fit : volume.fits) {
        EXPECT_EQ(complaint({volume.name, fit, overlap}), "");
        kinds.insert(treesNamed({volume.name, fit, overlap}).trees);
      }
  const std::set<TreeKind> all = {TreeKind::obb4,
#define CORRIDOR_KIND(kind, Volume, Overlap, volumeName, overlapName) TreeKind::kind,
                                  CORRIDOR_EACH_OVERLAP(CORRIDOR_KIND)
#undef CORRIDOR_KIND
  };
  EXPECT_EQ(kinds, all);

  const auto is = [](TreeKind trees, const TreeNames& words) {
    return treesNamed(words).trees == trees;
  };
  EXPECT_TRUE(is(TreeKind::obb4, {}));
  EXPECT_TRUE(is(TreeKind::obb4, {"obb", "hull", "sat"}));
  EXPECT_TRUE(is(TreeKind::obbBinary, {"obb-binary", "", ""}));
  EXPECT_TRUE(is(TreeKind::obbGjk, {"obb-binary", "", "gjk"}));
  EXPECT_TRUE(is(TreeKind::obbLinearProgram, {"obb-binary", "", "lp"}));
  EXPECT_TRUE(is(TreeKind::obbEdgeFace, {"obb-binary", "", "edge-face"}));
  EXPECT_TRUE(is(TreeKind::aabb, {"aabb", "plain", "sat"}));
  EXPECT_TRUE(is(TreeKind::sphere, {"sphere", "", "centers"}));
  EXPECT_TRUE(is(TreeKind::rss, {"rss", "vertices", "rectangles"}));
  EXPECT_TRUE(is(TreeKind::kdop14, {"kdop14", "", ""}));
  EXPECT_TRUE(is(TreeKind::kdop18, {"kdop18", "", "intervals"}));
  EXPECT_TRUE(is(TreeKind::kdop26, {"kdop26", "", ""}));
  EXPECT_TRUE(is(TreeKind::shell, {"shell", "plain", "distances"}));
  EXPECT_TRUE(is(TreeKind::ellipsoid, {"ellipsoid", "hull", "contact"}));
  EXPECT_TRUE(is(TreeKind::hull, {"hull", "", "gjk"}));
  EXPECT_EQ(treesNamed({"rss", "hull", ""}).params.fit, ObbFit::hull);
  EXPECT_EQ(treesNamed({"rss", "vertices", ""}).params.fit, ObbFit::vertices);
  EXPECT_EQ(treesNamed({"rss", "", ""}).params.fit, ObbFit::triangles);
  EXPECT_EQ(treesNamed({"aabb", "plain", ""}).params.fit, ObbFit::triangles);
}

TEST(TreeKinds, BinaryTreesAreBuiltInThreeWays) {
  const auto params = [](const std::string& build) {
    return treesNamed({"sphere", "", "", build}).params;
  };
  for (const char* topDown : {"", "top-down", "median"})
    EXPECT_EQ(params(topDown).building, TreeBuilding::topDown) << topDown;
  EXPECT_EQ(params("bottom-up").building, TreeBuilding::bottomUp);
  EXPECT_EQ(params("").split, SplitRule::mean);
  EXPECT_EQ(params("top-down").split, SplitRule::mean);
  EXPECT_EQ(params("median").split, SplitRule::median);
  for (const VolumeKind& volume : volumeKinds())
    for (const char* build : {"top-down", "median", "bottom-up"})
      EXPECT_EQ(complaint({volume.name, "", "", build}).empty(),
                volume.name != "obb" || std::string(build) == "top-down")
          << volume.name << build;
  EXPECT_TRUE(complaint({"", "", "", "bottom-up"})
                  .starts_with("build: \"bottom-up\" is for volumes obb-binary, aabb, "));
  EXPECT_TRUE(complaint({"obb", "", "", "median"}).ends_with("; volume obb has: top-down"));
  EXPECT_EQ(complaint({"aabb", "", "", "bottomup"}),
            "build: unknown build \"bottomup\" (did you mean \"bottom-up\"?); volume aabb has: "
            "top-down, median, bottom-up");
}

TEST(TreeKinds, HasDefaultOverlap) {
  for (const VolumeKind& volume : volumeKinds())
    for (const std::string& overlap : volume.overlaps)
      EXPECT_EQ(hasDefaultOverlap(treesNamed({volume.name, "", overlap}).trees),
                overlap == volume.overlaps.front())
          << volume.name << " " << overlap;
  EXPECT_FALSE(hasDefaultOverlap(TreeKind::obbGjk));
}

TEST(TreeKinds, WithDefaults) {
  const TreeNames usual = withDefaults({}), ball = withDefaults({"sphere", "", ""}),
                  said = withDefaults({"obb-binary", "hull", "lp"});
  EXPECT_EQ(usual.build + said.build, "top-downtop-down");
  EXPECT_EQ(withDefaults({"rss", "", "", "median"}).build, "median");
  EXPECT_EQ(usual.volume + " " + usual.fit + " " + usual.overlap, "obb triangles sat");
  EXPECT_EQ(ball.volume + " " + ball.fit + " " + ball.overlap, "sphere plain centers");
  EXPECT_EQ(said.volume + " " + said.fit + " " + said.overlap, "obb-binary hull lp");
}

TEST(TreeKinds, WrongNamesAreReportedWithTheValidOnes) {
  EXPECT_EQ(complaint({"spheres", "", ""}),
            "volume: unknown volume \"spheres\" (did you mean \"sphere\"?); there are: obb, "
            "obb-binary, aabb, sphere, rss, kdop14, kdop18, kdop26, shell, ellipsoid, hull");
  EXPECT_EQ(complaint({"sphere", "", "gjk"}),
            "overlap: \"gjk\" is for volumes obb-binary, hull; volume sphere has: centers");
  EXPECT_EQ(complaint({"", "", "gjk"}),
            "overlap: \"gjk\" is for volumes obb-binary, hull; volume obb has: sat");
  EXPECT_EQ(complaint({"aabb", "hull", ""}),
            "fit: \"hull\" is for volumes obb, obb-binary, rss, ellipsoid; volume aabb has: plain");
  EXPECT_EQ(complaint({"obb-binary", "", "gkj"}),
            "overlap: unknown overlap \"gkj\" (did you mean \"gjk\"?); volume obb-binary has: "
            "sat, gjk, lp, edge-face");
  EXPECT_EQ(complaint({"rss", "hul", ""}),
            "fit: unknown fit \"hul\" (did you mean \"hull\"?); volume rss has: triangles, "
            "vertices, hull");
  EXPECT_THROW(treesNamed({"aabb", "hull", ""}), std::invalid_argument);
  EXPECT_THROW(withDefaults({"cone", "", ""}), std::invalid_argument);
}

TEST(TreeKinds, BodiesBuildTreesInTheChosenWay) {
  std::mt19937_64 random(test::testSeed(52));
  const TriangleMesh soup = test::soup(random, 300, 0.2);
  std::vector<std::size_t> depths;
  for (const char* build : {"top-down", "median", "bottom-up"}) {
    const TreeChoice choice = treesNamed({"aabb", "", "", build});
    const Body body("soup", soup, false, choice.params);
    const VolumeTree<Aabb> own(soup, choice.params);
    const auto& tree = body.volumeTree<Aabb>();
    ASSERT_EQ(tree.nodes().size(), own.nodes().size()) << build;
    for (std::uint32_t i = 0; i < own.nodes().size(); ++i)
      ASSERT_TRUE(tree.node(i).count == own.node(i).count &&
                  tree.node(i).right == own.node(i).right)
          << build << i;
    depths.push_back(tree.depth());
  }
  EXPECT_LT(depths[1], depths[0]) << "trees split at the median are balanced";
  EXPECT_NE(depths[2], depths[0]);
  EXPECT_NE(depths[2], depths[1]);
}

/// Each tree of a body must be built when a query first needs it, and only once, even if several
/// threads need it at the same time.
TEST(TreeKinds, BodiesBuildTheChosenTrees) {
  std::mt19937_64 random(test::testSeed(51));
  const Body mesh("mesh", test::soup(random, 500, 0.2)), part("part", placed(Sphere{1}, {}));
  EXPECT_FALSE(mesh.treeBuilt() || part.treeBuilt());
  std::vector<const void*> seen(8);
  std::vector<std::thread> threads;
  for (std::size_t k = 0; k < seen.size(); ++k)
    threads.emplace_back([&, k] {
      // Half of the threads begin with the one kind of trees, the other threads with the other
      // kind.
      for (const TreeKind trees :
           {k % 2 ? TreeKind::rss : TreeKind::sphere, k % 2 ? TreeKind::sphere : TreeKind::rss})
        withVolume(trees, [&]<class Volume, class Overlap>() {
          const auto& tree = mesh.volumeTree<Volume>();
          EXPECT_EQ(tree.triangles().size(), mesh.mesh().triangles.size());
          if (trees == TreeKind::rss) seen[k] = &tree;
        });
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(std::set<const void*>(seen.begin(), seen.end()).size(), 1u);
  EXPECT_TRUE(mesh.treeBuilt());
  EXPECT_FALSE(part.treeBuilt());
  for (const TreeKind trees :
       {TreeKind::obbBinary, TreeKind::aabb, TreeKind::kdop14, TreeKind::kdop26, TreeKind::shell,
        TreeKind::ellipsoid, TreeKind::hull})
    withVolume(trees, [&]<class Volume, class Overlap>() {
      EXPECT_FALSE(test::treeFault(mesh.volumeTree<Volume>()));
      EXPECT_FALSE(test::treeFault(part.volumeTree<Volume>()));
      EXPECT_TRUE(part.volumeTree<Volume>().hasParts());
    });
  EXPECT_TRUE(part.treeBuilt());
}

}  // namespace
}  // namespace corridor
