// Queries of trees never claim that two trees are apart if a number of a map is not finite.
#include <gtest/gtest.h>

#include "collision/course/front.h"
#include "collision/course/octree_interference.h"
#include "collision/predicates/triangle_contact.h"
#include "collision/queries/contacts.h"
#include "collision/queries/distance_obb4.h"
#include "collision/queries/interference.h"
#include "collision/queries/interference_obb4.h"
#include "tests/collision/hierarchy/volumes.h"
#include "tests/support/meshes.h"
#include "tests/support/not_finite.h"

namespace corridor::test {
namespace {

struct Maps {
  Transform X_WA, X_WB;
};
/// Maps that take two bodies of 1 m to places 5 m apart: neither is the identity.
Maps someMaps() {
  Maps maps;
  maps.X_WA.m = Eigen::Quaterniond(1, 0.2, 0.1, 0.3).normalized().toRotationMatrix();
  maps.X_WA.t = Vec3(-1, -2, 0.5);
  maps.X_WB.m = Eigen::Quaterniond(1, -0.3, 0.4, 0.1).normalized().toRotationMatrix();
  maps.X_WB.t = Vec3(3, 2, 0.25);
  return maps;
}
template <class Check>
void forEachBadMap(const Check& check) {
  const auto numbersOf = [](Maps& maps) {
    std::vector<double*> numbers;
    addNumbers(maps.X_WA, numbers), addNumbers(maps.X_WB, numbers);
    return numbers;
  };
  forEachNotFinite(someMaps(), numbersOf, check);
}

const TriangleMesh kMesh = tessellatedCube(4);
ConvexPart part() {
  return placed(Cylinder{0.3, 0.7}, {});
}

template <class Tree>
void neverApart(const Tree& a, const Tree& b) {
  const auto touches = [&](const Maps& maps) {
    QueryContext context;
    return interference(Posed(a, maps.X_WA), Posed(b, maps.X_WB), context).has_value();
  };
  const auto distanceOf = [&](const Maps& maps) {
    QueryContext context;
    return distance(Posed(a, maps.X_WA), Posed(b, maps.X_WB), {}, context).distance;
  };
  const auto closer = [&](const Maps& maps, double d) {
    QueryContext context;
    return closerThan(Posed(a, maps.X_WA), Posed(b, maps.X_WB), d, context);
  };
  ASSERT_FALSE(touches(someMaps()) || closer(someMaps(), 0) || closer(someMaps(), 0.5));
  ASSERT_GT(distanceOf(someMaps()), 1);
  forEachBadMap([&](const Maps& bad, const std::string& what) {
    EXPECT_FALSE(claims([&] { return !touches(bad); })) << what;
    EXPECT_FALSE(claims([&] { return distanceOf(bad) > 0; })) << what;
    for (const double d : {0.0, 0.5})
      EXPECT_FALSE(claims([&] { return !closer(bad, d); })) << what << ", " << d;
    if (a.hasParts() || b.hasParts()) return;
    EXPECT_FALSE(claims([&] {
      QueryContext context;
      return contacts(Posed(a, bad.X_WA), Posed(b, bad.X_WB), context).empty();
    })) << what;
  });
  EXPECT_FALSE(claims([&] { return !closer(someMaps(), std::nan("")); }));
  const auto numbersOf = [](DistanceOptions& options) {
    return std::vector{&options.relative, &options.absolute, &options.upTo};
  };
  forEachNotFinite(DistanceOptions{}, numbersOf, [&](const DistanceOptions& bad, const auto& what) {
    // An infinite limit is legal, and with an infinite error, every distance is right.
    if (bad.relative >= 0 && bad.absolute >= 0 && bad.upTo >= 0) return;
    QueryContext context;
    const Posed<Tree> posedA(a, someMaps().X_WA), posedB(b, someMaps().X_WB);
    EXPECT_THROW(distance(posedA, posedB, bad, context), std::invalid_argument) << what;
  });
}

template <class Volume>
class NotFiniteMaps : public testing::Test {};
TYPED_TEST_SUITE(NotFiniteMaps, Volumes, VolumeNames);

TYPED_TEST(NotFiniteMaps, ProveNothing) {
  const VolumeTree<TypeParam> mesh(kMesh), convex(part());
  neverApart(mesh, mesh);
  neverApart(mesh, convex);
  neverApart(convex, convex);
}

TEST(NotFiniteMapsOfObb4, ProveNothing) {
  const Obb4Tree mesh(kMesh),
      convex(std::make_shared<const std::vector<ConvexPart>>(std::vector{part()}));
  neverApart(mesh, mesh);
  neverApart(mesh, convex);
  neverApart(convex, mesh);
  neverApart(convex, convex);
}

template <class Volume>
class NotFiniteMapsOfFronts : public testing::Test {};
using VolumesOfFronts = testing::Types<Obb, Rss>;
TYPED_TEST_SUITE(NotFiniteMapsOfFronts, VolumesOfFronts, VolumeNames);

TYPED_TEST(NotFiniteMapsOfFronts, ProveNothing) {
  const VolumeTree<TypeParam> mesh(kMesh);
  for (const bool warm : {false, true})
    forEachNotFinite(someMaps().X_WB, [&](const Transform& bad, const std::string& what) {
      Front front;
      QueryContext context;
      if (warm) {
        ASSERT_FALSE(interference(mesh, Posed(mesh, someMaps().X_WB), front, context));
      }
      EXPECT_FALSE(claims([&] { return !interference(mesh, Posed(mesh, bad), front, context); }))
          << what;
      // A good map afterwards must not meet the remains of the bad one.
      EXPECT_TRUE(interference(mesh, Posed(mesh, Transform()), front, context)) << what;
    });
}

TEST(NotFiniteMapsOfOctrees, ProveNothing) {
  const Octree octree(kMesh);
  const VolumeTree<Aabb> boxes(kMesh);
  forEachBadMap([&](const Maps& bad, const std::string& what) {
    QueryContext context;
    EXPECT_FALSE(claims([&] {
      return !interference(Posed(octree, bad.X_WA), Posed(octree, bad.X_WB), context);
    })) << what;
    EXPECT_FALSE(claims([&] {
      return !interference(Posed(octree, bad.X_WA), Posed(boxes, bad.X_WB), context);
    })) << what;
  });
}

TEST(NotFiniteTriangles, Touch) {
  struct Case {
    std::array<Triangle, 2> triangles;
    Maps maps;
  };
  const Triangle corners{Vec3(0.1, 0.2, 0.3), Vec3(1, 0.1, 0.2), Vec3(0.3, 1, 0.4)};
  const auto numbersOf = [](Case& c) {
    std::vector<double*> numbers;
    addNumbers(c.triangles, numbers);
    addNumbers(c.maps.X_WA, numbers), addNumbers(c.maps.X_WB, numbers);
    return numbers;
  };
  const auto touch = [](const Case& c) {
    return trianglesTouch(c.triangles[0], c.maps.X_WA, c.triangles[1], c.maps.X_WB);
  };
  const Case good{{corners, corners}, someMaps()};
  ASSERT_FALSE(touch(good));
  forEachNotFinite(good, numbersOf, [&](const Case& bad, const std::string& what) {
    EXPECT_TRUE(touch(bad)) << what;
  });
}

TEST(NotFiniteTrees, AreNotBuilt) {
  forEachNotFinite(kMesh, [](const TriangleMesh& bad, const std::string& what) {
    EXPECT_THROW(Obb4Tree{bad}, std::invalid_argument) << what;
    EXPECT_THROW(VolumeTree<Obb>{bad}, std::invalid_argument) << what;
    EXPECT_THROW(VolumeTree<BoundingSphere>{bad}, std::invalid_argument) << what;
    EXPECT_THROW(Octree{bad}, std::invalid_argument) << what;
  });
  forEachNotFinite(part(), [](const ConvexPart& bad, const std::string& what) {
    EXPECT_THROW(VolumeTree<Obb>{bad}, std::invalid_argument) << what;
    EXPECT_THROW(Obb4Tree{std::make_shared<const std::vector<ConvexPart>>(std::vector{bad})},
                 std::invalid_argument)
        << what;
  });
}

}  // namespace
}  // namespace corridor::test
