// Tests of pictures of the volumes of a tree.
#include "planner/view/volume_picture.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "collision/hierarchy/with_trees.h"
#include "planner/view/volume_outline.h"
#include "tests/support/soups.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

std::vector<std::string> volumeNames() {
  std::vector<std::string> names;
  for (const VolumeKind& kind : volumeKinds()) names.push_back(kind.name);
  return names;
}

double supportOf(const ConvexPart& part, const Vec3& along) {
  double most = -HUGE_VAL;
  for (const Vec3& p : part.points) most = std::max(most, p.dot(along));
  return most + part.radius * along.norm();
}

/// An outline contains the triangles of its volume, and is inside the sphere around the volume, up
/// to rounding. (Corners of k-DOPs closer than 1e-7 of their size are drawn as one.) Ellipsoids and
/// shells are drawn as polyhedra with corners on the surface, 22.5° apart in two directions: their
/// faces are inside by up to 1 − cos²(11.25°) = 3.8 % of the radius.
TEST(VolumeOutlines, AreThoseOfTheirVolumes) {
  std::mt19937_64 random(test::testSeed(91));
  std::normal_distribution<double> normal;
  const TriangleMesh mesh = test::soup(random, 60, 0.2);
  for (const std::string& name : volumeNames()) {
    if (name == "obb")
      continue;  // the boxes of `obb` are drawn in the same way as those of obb-binary
    withVolume(treesNamed({name, "", ""}).trees, [&]<class Volume, class Overlap>() {
      const VolumeTree<Volume> tree(mesh);
      const double inside = name == "ellipsoid" || name == "shell" ? 0.039 : 0;
      for (const auto& node : tree.nodes()) {
        const ConvexPart part = view::outline(node.box);
        ASSERT_FALSE(part.points.empty()) << name;
        for (const Vec3& p : part.points)
          ASSERT_LE((p - node.box.ballCenter()).norm() + part.radius, node.radius + 1e-9) << name;
        for (int i = 0; i < 20; ++i) {
          const Vec3 along = Vec3(normal(random), normal(random), normal(random)).normalized();
          double content = -HUGE_VAL;
          for (std::uint32_t t = node.first; t < node.first + node.count; ++t)
            for (const Vec3& corner : tree.triangle(t))
              content = std::max(content, corner.dot(along));
          ASSERT_GE(supportOf(part, along), content - inside * node.radius - 1e-6) << name;
        }
      }
    });
  }
}

TEST(VolumePictures, ShowALevel) {
  std::mt19937_64 random(test::testSeed(92));
  const TriangleMesh mesh = test::soup(random, 200, 0.1);
  for (const std::string& name : volumeNames()) {
    SCOPED_TRACE(name);
    std::size_t before = 0, levels = 0;
    for (const std::size_t level : {0, 1, 2, 4}) {
      const VolumePicture picture = volumePicture(mesh, {name, "", ""}, level);
      EXPECT_EQ(picture.drawn, picture.volumes);
      EXPECT_GT(picture.volumes, before);
      if (level == 0) {
        EXPECT_EQ(picture.volumes, 1u);
        levels = picture.levels;
      }
      EXPECT_EQ(picture.levels, levels);
      EXPECT_TRUE(picture.svg.starts_with("<svg ") && picture.svg.ends_with("</svg>\n"));
      EXPECT_LT(picture.svg.size(), 200'000u);
      before = picture.volumes;
    }
    // The last level has all leaves; only the nearest fit into the picture.
    const VolumePicture last = volumePicture(mesh, {name, "", ""}, 1'000'000);
    EXPECT_GT(last.volumes, 100u);
    EXPECT_LE(last.drawn, last.volumes);
    EXPECT_LT(last.svg.size(), 200'000u);
  }
}

/// The volumes of a flat mesh have no interior, and those of a point have no extent.
TEST(VolumePictures, OfFlatMeshes) {
  TriangleMesh flat, point;
  for (int i = 0; i < 9; ++i) test::add(flat, Vec3(i, 0, 0), Vec3(i + 1, 0, 0), Vec3(i, 1, 0));
  test::add(point, Vec3(1, 2, 3), Vec3(1, 2, 3), Vec3(1, 2, 3));
  for (const std::string& name : volumeNames())
    for (const TriangleMesh* mesh : {&flat, &point}) {
      const VolumePicture picture = volumePicture(*mesh, {name, "", ""}, 2);
      EXPECT_GE(picture.drawn, 1u) << name;
      // Behind the image, whose base64 may have any letters.
      EXPECT_EQ(picture.svg.find("nan", picture.svg.find("/>")), std::string::npos) << name;
    }
}

}  // namespace
}  // namespace corridor
