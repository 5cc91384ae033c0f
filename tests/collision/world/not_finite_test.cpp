// NaN and ±infinity in every number that the queries of bodies and scenes take, one at a time: no
// answer is ever `free`, "separated" or a positive distance.
#include "tests/support/not_finite.h"

#include <array>
#include <optional>

#include <gtest/gtest.h>

#include "collision/course/body_depth.h"
#include "collision/world/body_queries.h"
#include "collision/world/rigid_scene.h"
#include "tests/collision/motion/bodies.h"

namespace corridor::test {
namespace {

TriangleMesh cube(double size) {
  return box(Vec3::Constant(-size / 2), Vec3::Constant(size / 2));
}
/// Bodies of all kinds, of about 1 m.
std::vector<Body> someBodies() {
  std::vector<Body> bodies;
  bodies.emplace_back("surface", cube(1));
  bodies.emplace_back("solid", cube(1), true);
  bodies.emplace_back("box", placed(Box{Vec3(1, 0.8, 0.6)}, {}));
  bodies.emplace_back("cylinder", placed(Cylinder{0.4, 0.9}, {}));
  return bodies;
}
Transform shifted(const Vec3& p) {
  Transform X;
  X.t = p;
  return X;
}
const Transform kFar = shifted(Vec3(5, 4, 3));

bool isNaN(double x) {
  return x != x;
}

TEST(NotFinite, MapsOfBodiesAreRefused) {
  const std::vector<Body> bodies = someBodies();
  QueryContext context;
  for (const Body& a : bodies)
    for (const Body& b : bodies)
      forEachNotFinite(kFar, [&](const Transform& bad, const std::string& what) {
        for (const bool first : {false, true}) {
          const Posed<Body> x(a, first ? bad : Transform()), y(b, first ? Transform() : bad);
          EXPECT_THROW(interference(x, y, context), std::invalid_argument) << what;
          EXPECT_THROW(distance(x, y, {}, context), std::invalid_argument) << what;
          EXPECT_THROW(closerThan(x, y, 0.1, context), std::invalid_argument) << what;
          EXPECT_THROW(findOneInsideOther(x, y, context), std::invalid_argument) << what;
          EXPECT_THROW(contacts(x, y, context), std::invalid_argument) << what;
        }
        EXPECT_THROW(depthBounds(a, b, bad, {}, context), std::invalid_argument) << what;
      });
}

TEST(NotFinite, OptionsOfBodyQueriesAreRefused) {
  const std::vector<Body> bodies = someBodies();
  const Posed<Body> a(bodies[0]), b(bodies[2], kFar);
  QueryContext context;
  for (const double bad : kNotFinite) {
    EXPECT_THROW(closerThan(a, b, bad, context), std::invalid_argument);
    EXPECT_THROW(distance(a, b, {.relative = bad}, context), std::invalid_argument);
    EXPECT_THROW(distance(a, b, {.absolute = bad}, context), std::invalid_argument);
    EXPECT_THROW(depthBounds(bodies[0], bodies[2], {}, {{}, bad}, context), std::invalid_argument);
    EXPECT_THROW(depthBounds(bodies[0], bodies[2], {}, {{Vec3(0, bad, 1)}}, context),
                 std::invalid_argument);
  }
  EXPECT_THROW(distance(a, b, {.upTo = std::nan("")}, context), std::invalid_argument);
}

TEST(NotFinite, BodiesAreNotMade) {
  forEachNotFinite(cube(1), [](const TriangleMesh& bad, const std::string& what) {
    EXPECT_THROW(Body("x", bad), std::invalid_argument) << what;
    EXPECT_THROW(Body("x", bad, true), std::invalid_argument) << what;
  });
  for (const Primitive& good : {Primitive(Box{Vec3(1, 1, 1)}), Primitive(Sphere{1}),
                                Primitive(Capsule{1, 1}), Primitive(Cylinder{1, 1})}) {
    forEachNotFinite(placed(good, {}), [](const ConvexPart& bad, const std::string& what) {
      EXPECT_THROW(Body("x", bad), std::invalid_argument) << what;
    });
    forEachNotFinite(kFar, [&](const Transform& bad, const std::string& what) {
      // A pose need not enter every point: a sphere has one, at the origin of its frame.
      if (bad.t.allFinite() && std::holds_alternative<Sphere>(good)) return;
      EXPECT_THROW(Body("x", placed(good, bad)), std::invalid_argument) << what;
    });
  }
}

/// A scene of three frames: the world with two bodies, and a body on each of two frames.
Scene someScene(const Transform& X_WRest = kFar) {
  std::vector<Scene::Placed> placedBodies;
  placedBodies.push_back({Body("a", cube(1)), 0});
  placedBodies.push_back({Body("b", placed(Sphere{0.5}, {})), 3, X_WRest});
  placedBodies.push_back({Body("c", cube(1)), 1});
  placedBodies.push_back({Body("d", placed(Cylinder{0.4, 0.9}, {})), 2});
  return {std::move(placedBodies), {{0, 2}, {1, 2}, {0, 3}, {1, 3}, {2, 3}}};
}

TEST(NotFinite, PosesOfFramesAreRefused) {
  forEachNotFinite(kFar, [](const Transform& bad, const std::string& what) {
    EXPECT_THROW(someScene(bad), std::invalid_argument) << what;
  });
  const Scene scene = someScene();
  const std::array good{Transform(), shifted(Vec3(-4, 0, 0)), shifted(Vec3(0, -4, 0))};
  QueryContext context;
  ASSERT_FALSE(scene.interference(good, context));
  const PairMargins within(std::vector<double>(5, 1.0));
  forEachNotFinite(good, [&](const auto& bad, const std::string& what) {
    EXPECT_THROW(scene.interference(bad, context), std::invalid_argument) << what;
    EXPECT_THROW(scene.clearance(bad, context), std::invalid_argument) << what;
    EXPECT_THROW(scene.pairsWithin(bad, within, {}, context, {}), std::invalid_argument) << what;
  });
  for (const double bad : kNotFinite)
    for (std::size_t i = 0; i < 3; ++i) {
      std::vector<double> metres(3, 0.1);
      metres[i] = bad;
      EXPECT_THROW(PairMargins{metres}, std::invalid_argument);
    }
}

MotionOptions someOptions() {
  MotionOptions options;
  options.tolerance = options.clearanceSlack = 1e-6;
  options.margin = 0.001;
  return options;
}

TEST(NotFinite, RigidScenesRefuse) {
  std::vector<Body> moving, fixed;
  moving.emplace_back("b", cube(1));
  fixed.emplace_back("a", cube(1));
  const RigidScene scene(std::move(moving), std::move(fixed));
  QueryContext context;
  const std::array<RigidPose, 2> ends{at(Vec3(5, 4, 3)), at(Vec3(4, 5, 4))};
  forEachNotFinite(ends, [&](const auto& bad, const std::string& what) {
    EXPECT_THROW(scene.certifyEdge(bad[0], bad[1], someOptions(), context), std::invalid_argument)
        << what;
  });
  forEachNotFinite(ends[0], [&](const RigidPose& bad, const std::string& what) {
    EXPECT_THROW(scene.certifyState(bad, someOptions(), context), std::invalid_argument) << what;
  });
  const std::array<Vec3, 2> planar{Vec3(5, 4, 0.1), Vec3(4, 5, 0.3)};
  forEachNotFinite(planar, [&](const auto& bad, const std::string& what) {
    EXPECT_THROW(scene.certifyEdgePlanar(bad[0], bad[1], someOptions(), context),
                 std::invalid_argument)
        << what;
  });
  const auto numbersOf = [](Tube& tube) { return std::vector{&tube.position, &tube.rotation}; };
  forEachNotFinite(Tube{}, numbersOf, [&](const Tube& bad, const std::string& what) {
    EXPECT_THROW(scene.certifyEdge(ends[0], ends[1], someOptions(), context, bad),
                 std::invalid_argument)
        << what;
  });
  forEachNotFinite(Transform(), [&](const Transform& bad, const std::string& what) {
    EXPECT_THROW(scene.interference(bad, context), std::invalid_argument) << what;
  });
}

TEST(NotFinite, BoxesOfTreesAreRefused) {
  const std::array<Vec3, 2> corners{Vec3(0, 0, 0), Vec3(1, 1, 1)};
  forEachNotFinite(corners, [](const auto& bad, const std::string& what) {
    BoundingBox box;
    box.lower = bad[0], box.upper = bad[1];
    if (!isNaN(bad[0].sum() + bad[1].sum())) return;
    EXPECT_THROW(BoxTree(std::span(&box, 1)), std::invalid_argument) << what;
    BoxTree tree;
    EXPECT_THROW(tree.insert(0, box), std::invalid_argument) << what;
  });
}

}  // namespace
}  // namespace corridor::test
