// Calls every query of collision/collision.h as its manual shows, on bodies for which the answers
// are known.
#include <gtest/gtest.h>

#include "collision/collision.h"
#include "collision/course/body_depth.h"
#include "tests/support/meshes.h"

namespace corridor {
namespace {

/// A cube of 1 m, as a mesh and as a convex part.
struct Cubes {
  Body mesh{"cube", test::box(Vec3::Constant(-0.5), Vec3::Constant(0.5)), true};
  Body part{"box", placed(Box{Vec3::Ones()}, {})};
  QueryContext context;
};
Transform at(double x) {
  return {Mat3::Identity(), Vec3(x, 0, 0)};
}

TEST(Manual, DoTheyTouch) {
  Cubes c;
  for (const Body* other : {&c.mesh, &c.part}) {
    EXPECT_TRUE(interference({c.mesh, at(1)}, {*other}, c.context)) << "touching is contact";
    EXPECT_FALSE(interference({c.mesh, at(1.25)}, {*other}, c.context));
  }
}

TEST(Manual, WhichTrianglesTouchAndWhere) {
  Cubes c;
  const auto found = contacts({c.mesh, at(0.75)}, {c.mesh}, c.context);
  EXPECT_FALSE(found.empty());
  for (const TriangleContact& contact : found) {
    EXPECT_LE(std::abs(contact.p_W.x() - 0.375), 0.125 + 1e-12);
    EXPECT_LT(contact.a, 12U);
    EXPECT_LT(contact.b, 12U);
  }
  EXPECT_TRUE(contacts({c.mesh, at(2)}, {c.mesh}, c.context).empty());
  EXPECT_THROW(contacts({c.mesh, at(2)}, {c.part}, c.context), std::invalid_argument);
  for (const TreeKind trees : {TreeKind::obbBinary, TreeKind::sphere})
    EXPECT_EQ(contacts({c.mesh, at(0.75)}, {c.mesh}, c.context, trees).size(), found.size());
}

TEST(Manual, HowFarApart) {
  Cubes c;
  LastPair last;
  for (const double x : {3.0, 2.9, 2.8}) {
    const Distance d = distance({c.mesh, at(x)}, {c.mesh}, {}, c.context, TreeKind::obb4, &last);
    EXPECT_NEAR(d.distance, x - 1, 1e-12);
    EXPECT_NEAR((d.p_WA - d.p_WB).norm(), d.distance, 1e-12);
    EXPECT_NEAR(distance({c.part, at(x)}, {c.mesh}, {}, c.context).distance, x - 1, 1e-12);
  }
}

TEST(Manual, HowDeep) {
  Cubes c;
  for (const Body* other : {&c.mesh, &c.part}) {
    const DepthBounds d = depthBounds(c.mesh, *other, at(0.75), {}, c.context);
    EXPECT_LE(d.lower, 0.25);
    EXPECT_NEAR(d.upper, 0.25, 1e-4);
    EXPECT_EQ(depthBounds(c.mesh, *other, at(1.25), {}, c.context).upper, 0);
  }
}

TEST(Manual, AtMostThatFarApart) {
  Cubes c;
  for (const Body* other : {&c.mesh, &c.part}) {
    EXPECT_TRUE(closerThan({c.mesh, at(1.25)}, {*other}, 0.25, c.context));
    EXPECT_FALSE(closerThan({c.mesh, at(1.25)}, {*other}, 0.2499, c.context));
  }
}

TEST(Manual, IsOneInsideTheOther) {
  Cubes c;
  const Body small("small", test::box(Vec3::Constant(-0.1), Vec3::Constant(0.1)));
  EXPECT_TRUE(findOneInsideOther({small, at(0.2)}, {c.mesh}, c.context));
  EXPECT_TRUE(interference({small, at(0.2)}, {c.mesh}, c.context)) << "the mesh is solid";
  EXPECT_FALSE(findOneInsideOther({small, at(2)}, {c.mesh}, c.context));
}

TEST(Manual, FirstContactAlongAMotion) {
  std::vector<Body> moving, fixed;
  moving.emplace_back("piano", test::box(Vec3::Constant(-0.5), Vec3::Constant(0.5)));
  fixed.emplace_back("wall", test::box(Vec3(4.5, -5, -5), Vec3(5, 5, 5)));
  const RigidScene scene(std::move(moving), std::move(fixed));
  QueryContext context;
  MotionOptions options;
  options.tolerance = scene.defaultTolerance();
  options.earliest = true;
  const RigidPose from, near{Vec3(3, 0, 0), Eigen::Quaterniond::Identity()},
      into{Vec3(8, 0, 0), Eigen::Quaterniond::Identity()};
  EXPECT_EQ(scene.certifyEdge(from, near, options, context).verdict, MotionVerdict::free);
  const MotionResult r = scene.certifyEdge(from, into, options, context);
  EXPECT_EQ(r.verdict, MotionVerdict::contact);
  EXPECT_LE(r.certifiedUntil, 0.5);
  EXPECT_GE(r.time, 0.5);
  EXPECT_LE(r.time - r.certifiedUntil, options.timeTolerance);
  EXPECT_EQ(context.counters.edges, 2U);
}

}  // namespace
}  // namespace corridor
