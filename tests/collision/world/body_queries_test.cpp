#include "collision/world/body_queries.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "collision/world/rigid_scene.h"

namespace corridor {
namespace {

/// Returns the surface of a cube of edge 2 about the origin; with `hollow`, also the surface of a
/// cube of edge 1 inside.
TriangleMesh cube(bool hollow = false) {
  TriangleMesh mesh;
  for (const double half : {1.0, 0.5}) {
    if (half < 1 && !hollow) break;
    const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int i = 0; i < 8; ++i)
      mesh.vertices.push_back(half * Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
    const std::uint32_t faces[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6},
                                        {0, 1, 5}, {0, 5, 4}, {2, 6, 7}, {2, 7, 3},
                                        {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    for (const auto& f : faces) mesh.triangles.push_back({n + f[0], n + f[1], n + f[2]});
  }
  return mesh;
}

const Primitive kPrimitives[] = {Box{Vec3(0.2, 0.3, 0.4)}, Sphere{0.2}, Capsule{0.1, 0.2},
                                 Cylinder{0.2, 0.3},
                                 Convex{{{0, 0, 0}, {0.2, 0, 0}, {0, 0.2, 0}, {0, 0, 0.2}}}};

TEST(BodyQueries, InsideASolidMesh) {
  const Body solid("solid", cube(), true), surface("surface", cube());
  QueryContext context;
  const Transform in{Mat3::Identity(), Vec3(0.1, 0.2, -0.1)}, out{Mat3::Identity(), Vec3(4, 0, 0)};
  std::vector<Body> small;
  for (const Primitive& p : kPrimitives) small.emplace_back(nameOf(p), placed(p, {}));
  TriangleMesh little = cube();
  for (Vec3& v : little.vertices) v *= 0.1;
  small.emplace_back("mesh", little);
  for (const Body& body : small) {
    SCOPED_TRACE(body.name());
    EXPECT_TRUE(interference(Posed(solid), Posed(body, in), context));
    EXPECT_TRUE(interference(Posed(body, in), Posed(solid), context));
    for (const Distance& d : {distance(Posed(solid), Posed(body, in), {}, context),
                              distance(Posed(body, in), Posed(solid), {}, context)}) {
      EXPECT_EQ(d.distance, 0);
      EXPECT_EQ(d.p_WA, d.p_WB);
      EXPECT_LT((d.p_WA - in.t).norm(), 0.4);  // the witness point is in the small body
    }
    EXPECT_TRUE(closerThan(Posed(solid), Posed(body, in), 0, context));
    EXPECT_TRUE(closerThan(Posed(body, in), Posed(solid), 1e-3, context));

    // The surface alone does not touch the body inside, and their distance is not 0.
    EXPECT_FALSE(interference(Posed(surface), Posed(body, in), context));
    const Distance d = distance(Posed(surface), Posed(body, in), {}, context);
    EXPECT_GT(d.distance, 0.4);
    EXPECT_LT(d.distance, 0.9);
    EXPECT_FALSE(closerThan(Posed(surface), Posed(body, in), 0.3, context));
    EXPECT_TRUE(closerThan(Posed(surface), Posed(body, in), 0.9, context));

    // Outside, a solid and its surface have the same distance.
    const Distance beside = distance(Posed(solid), Posed(body, out), {}, context);
    EXPECT_GT(beside.distance, 2.5);
    EXPECT_EQ(beside.distance, distance(Posed(surface), Posed(body, out), {}, context).distance);
    EXPECT_NEAR(beside.distance, distance(Posed(body, out), Posed(solid), {}, context).distance,
                1e-14);
    EXPECT_FALSE(closerThan(Posed(solid), Posed(body, out), 2.4, context));
  }
}

TEST(BodyQueries, BodiesInsidePrimitivesTouchThem) {
  const Body box("box", placed(Box{Vec3(2, 2, 2)}, {})), mesh("mesh", cube(true));
  const Transform larger{2 * Mat3::Identity(), Vec3::Zero()};
  QueryContext context;
  EXPECT_TRUE(interference(Posed(box, larger), Posed(mesh), context));
  EXPECT_EQ(distance(Posed(mesh), Posed(box, larger), {}, context).distance, 0);
}

/// The hollow of a shell counts as inside (queries/containment.h).
TEST(BodyQueries, Hollow) {
  const Body shell("shell", cube(true), true), ball("ball", placed(Sphere{0.1}, {}));
  QueryContext context;
  EXPECT_EQ(distance(Posed(shell), Posed(ball), {}, context).distance, 0);
}

/// Tests all pairs of kinds of bodies, at known gaps: the highest and lowest z of every body are
/// known.
TEST(BodyQueries, AllPairs) {
  std::vector<Body> bodies;
  std::vector<double> low, high;
  for (const Primitive& p : kPrimitives) {
    bodies.emplace_back(nameOf(p), placed(p, {}));
    low.push_back(bodies.back().lower()[2]);
    high.push_back(bodies.back().upper()[2]);
  }
  bodies.emplace_back("mesh", cube());
  bodies.emplace_back("solid", cube(true), true);
  low.insert(low.end(), {-1, -1});
  high.insert(high.end(), {1, 1});
  QueryContext context;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    for (std::size_t k = 0; k < bodies.size(); ++k)
      for (const double gap : {0.5, 1e-4, 1e-10, -1e-3}) {
        SCOPED_TRACE(bodies[i].name() + " " + bodies[k].name());
        const Transform X{Mat3::Identity(), Vec3(0, 0, high[i] - low[k] + gap)};
        const Distance d = distance(Posed(bodies[i]), Posed(bodies[k], X), {}, context);
        const double expected = std::max(gap, 0.0);
        EXPECT_NEAR(d.distance, expected, 2e-15);
        EXPECT_EQ(interference(Posed(bodies[i]), Posed(bodies[k], X), context).has_value(),
                  gap < 0);
        EXPECT_TRUE(closerThan(Posed(bodies[i]), Posed(bodies[k], X), expected + 3e-15, context));
        EXPECT_EQ(closerThan(Posed(bodies[i]), Posed(bodies[k], X), expected / 2, context),
                  gap < 0);
      }
}

TEST(BodyQueries, RejectsInvalidPrimitives) {
  const auto message = [](const Primitive& primitive) -> std::string {
    try {
      Body("x", placed(primitive, {}));
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  const double inf = std::numeric_limits<double>::infinity();
  for (const double radius : {-1.0, -1e-300, inf, static_cast<double>(NAN)})
    for (const Primitive& p :
         {Primitive(Sphere{radius}), Primitive(Capsule{radius, 1}), Primitive(Cylinder{radius, 1})})
      EXPECT_EQ(message(p), "body x: the radius must be finite and not negative");
  for (const Primitive& p : {Primitive(Box{Vec3(1, NAN, 1)}), Primitive(Capsule{1, inf}),
                             Primitive(Convex{{Vec3::Zero(), Vec3(0, inf, 0)}})})
    EXPECT_EQ(message(p), "body x has a point that is not finite");
  EXPECT_EQ(message(Convex{}), "body x has no points");
  EXPECT_THROW(Body("x", ConvexPart{{Vec3::Zero()}, 1, true}), std::invalid_argument);
  EXPECT_EQ(message(Sphere{0}), "");
}

/// A cylinder is so short that, after rounding, its axis has length 0 and no direction. Its bounds
/// must contain the disc for every possible axis, because motion queries test the bounds first.
TEST(BodyQueries, CylinderWithoutAnAxisKeepsItsBounds) {
  const Transform X{Mat3::Identity(), Vec3(0.7, 0.2, 0.1)};
  const ConvexPart disc = placed(Cylinder{0.3, 1e-20}, X);
  ASSERT_EQ(disc.points[0], disc.points[1]);
  const Body body("disc", disc);
  for (int i = 0; i < 2; ++i) {
    EXPECT_LE(body.lower()[i], X.t[i] - 0.3);
    EXPECT_GE(body.upper()[i], X.t[i] + 0.3);
  }
  std::vector<Body> fixed, moving;
  fixed.emplace_back("disc", disc);
  moving.emplace_back("ball", placed(Sphere{0.05}, {}));
  const RigidScene scene(std::move(moving), std::move(fixed));
  QueryContext context;
  MotionOptions options;
  options.tolerance = scene.defaultTolerance();
  RigidPose touching;
  touching.p = Vec3(0.42, 0.2, 0.1);
  EXPECT_TRUE(scene.interference({Mat3::Identity(), touching.p}, context));
  EXPECT_EQ(scene.certifyState(touching, options, context).verdict, MotionVerdict::contact);
}

TEST(BodyQueries, RejectsNonFiniteInput) {
  const Body a("a", cube()), b("b", placed(Sphere{0.1}, {}));
  QueryContext context;
  Transform bad;
  bad.t[1] = NAN;
  const auto message = [](const auto& query) -> std::string {
    try {
      query();
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message([&] { interference(Posed(a, bad), Posed(b), context); }),
            "the pose of a body must be finite");
  EXPECT_EQ(message([&] { distance(Posed(a), Posed(b, bad), {}, context); }),
            "the pose of a body must be finite");
  EXPECT_EQ(message([&] { closerThan(Posed(a), Posed(b, bad), 1, context); }),
            "the pose of a body must be finite");
  const Body solid("solid", cube(), true);
  for (const Body* other : {&a, &b, &solid}) {
    EXPECT_EQ(message([&] { findOneInsideOther(Posed(solid), Posed(*other, bad), context); }),
              "the pose of a body must be finite");
    EXPECT_EQ(message([&] { findOneInsideOther(Posed(*other, bad), Posed(solid), context); }),
              "the pose of a body must be finite");
  }
  EXPECT_EQ(message([&] {
              distance(Posed(a), Posed(b), {-1, 0}, context);
            }),
            "a distance's relative error must be finite and not negative");
  EXPECT_EQ(message([&] {
              distance(Posed(a), Posed(b), {0, NAN}, context);
            }),
            "a distance's absolute error must be finite and not negative");
  EXPECT_EQ(message([&] { closerThan(Posed(a), Posed(b), -0.1, context); }),
            "a tolerance must be finite and not negative");
}

}  // namespace
}  // namespace corridor
