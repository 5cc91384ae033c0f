// Tests of the default method only. Tests for every method are in edge_methods_test.cpp.
#include "collision/motion/certify_motion.h"

#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "collision/convex/convex_distance.h"
#include "collision/convex/polytope.h"
#include "collision/core/rigid_pose.h"
#include "collision/queries/interference.h"
#include "tests/collision/motion/bodies.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::add;
using test::at;
using test::blob;
using test::bodyOf;
using test::box;
using test::certify;
using test::randomEdge;
using test::turned;

// ---- closed forms ----

TEST(CertifyMotion, BoxPastAWall) {
  const Body wall = bodyOf(box(Vec3(-10, 1, -10), Vec3(10, 1.5, 10))),
             cube = bodyOf(box(Vec3(-0.5, -0.5, -0.5), Vec3(0.5, 0.5, 0.5)));
  for (const double gap : {0.25, 1e-4, 1e-6, 3e-7, -3e-7, -1e-6, -1e-4, -0.25}) {
    QueryContext context;
    const RigidPose a = at(Vec3(-5, 0.5 - gap, 0)), b = at(Vec3(5, 0.5 - gap, 0));
    MotionOptions options;
    options.tolerance = 1e-7;
    const MotionResult r = certify(cube, wall, RigidMotion::spatial(a, b, {}), options, context);
    EXPECT_EQ(r.verdict, gap > 0 ? MotionVerdict::free : MotionVerdict::contact) << gap;
    if (gap > 0) {
      EXPECT_LE(context.counters.poses, 64U)
          << "sliding at gap " << gap << " must need few intervals";
    }
  }
}

/// A cube moves 10 m along a wall, at a distance or depth of 1e-10 m or less. It moves in the
/// direction of one of its edges, or diagonally. Each motion is also tested with both bodies and
/// the motion rotated, so that coordinates are off by 1e-15 m. The cost is measured by counters,
/// not by time.
TEST(CertifyMotion, BoxPastAWallAlmostTouching) {
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  for (const Mat3& R : {Mat3(Mat3::Identity()), turn}) {
    TriangleMesh wallMesh, cubeMesh;
    test::addBox(wallMesh, Vec3(-10, 0, -10), Vec3(10, 0.5, 10), R);
    test::addBox(cubeMesh, Vec3(-0.5, -1, -0.5), Vec3(0.5, 0, 0.5), R);
    const Body wall = bodyOf(wallMesh), cube = bodyOf(cubeMesh);
    for (const Vec3& along : {Vec3(1, 0, 0), Vec3(1, 0, 1), Vec3(-3, 0, 2)})
      for (const double gap : {1e-10, 3e-11, -3e-11, -1e-10}) {
        const Vec3 half = 5 * along.normalized(), down(0, -gap, 0);
        MotionOptions options;
        options.tolerance = 1e-11;
        QueryContext context;
        const RigidMotion slide =
            RigidMotion::spatial(at(R * (down - half)), at(R * (down + half)), {});
        const MotionResult r = certify(cube, wall, slide, options, context);
        EXPECT_EQ(r.verdict, gap > 0 ? MotionVerdict::free : MotionVerdict::contact)
            << gap << " along " << along.transpose();
        EXPECT_LE(context.counters.poses, 64U) << gap << " along " << along.transpose();
        EXPECT_LE(context.counters.splits, 64U);
      }
  }
}

/// A needle moves through a hole. The motion is free if the needle's radius is below the inscribed
/// radius of the hole.
TEST(CertifyMotion, NeedleThroughAHole) {
  const double hole = 0.1, thick = 0.05;
  TriangleMesh plate;
  const int n = 64;
  // Adds both faces and the rim of a round hole in a plate, z ∈ [0, thick].
  for (int i = 0; i < n; ++i) {
    const double a = 2 * std::numbers::pi * i / n, b = 2 * std::numbers::pi * (i + 1) / n;
    const Vec3 p(hole * std::cos(a), hole * std::sin(a), 0),
        q(hole * std::cos(b), hole * std::sin(b), 0), up(0, 0, thick);
    add(plate, p, q, 20 * p), add(plate, q, 20 * p, 20 * q);
    add(plate, p + up, q + up, 20 * p + up), add(plate, q + up, 20 * p + up, 20 * q + up);
    add(plate, p, q, q + up), add(plate, p, p + up, q + up);
  }
  const Body tree = bodyOf(plate);
  // The inscribed radius of the hole is 0.1·cos(π/64) = 0.09988.
  for (const double radius : {0.05, 0.0985, 0.0999, 0.1001}) {
    TriangleMesh needle;
    for (int i = 0; i < 6; ++i) {
      const double a = std::numbers::pi * i / 3, b = std::numbers::pi * (i + 1) / 3;
      const Vec3 p(radius * std::cos(a), radius * std::sin(a), -1),
          q(radius * std::cos(b), radius * std::sin(b), -1);
      add(needle, p, q, Vec3(0, 0, 1));
    }
    QueryContext context;
    MotionOptions options;
    options.tolerance = 1e-7;
    const MotionResult r = certify(
        bodyOf(needle), tree,
        RigidMotion::spatial(at(Vec3(0, 0, -2)), turned(Vec3(0, 0, 3), 1, Vec3::UnitZ()), {}),
        options, context);
    EXPECT_EQ(r.verdict, radius < 0.09988 ? MotionVerdict::free : MotionVerdict::contact) << radius;
  }
}

// ---- random edges ----

/// Queries with `earliest`, queries of the reversed motion and queries with margins must agree with
/// the verdict of the plain query. If the verdict is `free`, the exact interference test must find
/// no contact at sampled, rounded poses of the motion. (These poses are inside the default tube.)
TEST(CertifyMotion, RandomEdges) {
  std::mt19937_64 random(test::testSeed(9));
  const int count = test::casesOf(1'700, 450'000);
  int free = 0, contact = 0, undecided = 0;
  for (int n = 0; n < count; ++n) {
    const Body fixed = bodyOf(blob(random, 60, 2, 0.3)),
               moving = bodyOf(blob(random, 12, 0.3, 0.3));
    const auto [a, b] = randomEdge(random);
    MotionOptions options;
    options.tolerance = 1e-7;
    QueryContext context;
    const RigidMotion motion = RigidMotion::spatial(a, b, {0x1p-40 * 4, 0x1p-40 * 6});
    const MotionResult r = certify(moving, fixed, motion, options, context);
    options.earliest = true;
    const MotionResult first = certify(moving, fixed, motion, options, context);
    ASSERT_EQ(r.verdict == MotionVerdict::free, first.verdict == MotionVerdict::free) << n;
    (r.verdict == MotionVerdict::free      ? free
     : r.verdict == MotionVerdict::contact ? contact
                                           : undecided)++;
    const double until = r.verdict == MotionVerdict::free ? 1 : first.certifiedUntil;
    for (int i = 0; i <= 100 && until > 0; ++i)
      ASSERT_FALSE(interference(Posed(fixed.binaryTree()),
                                Posed(moving.binaryTree(), motion.at(until * i / 100)), context))
          << n << " at " << i;
    const MotionResult back =
        certify(moving, fixed, RigidMotion::spatial(b, a, {}), options, context);
    if (r.verdict == MotionVerdict::free) {
      ASSERT_NE(back.verdict, MotionVerdict::contact);
      options.margin = 1e-9;
      ASSERT_NE(certify(moving, fixed, motion, options, context).verdict, MotionVerdict::contact)
          << n;
    } else if (r.verdict == MotionVerdict::contact) {
      ASSERT_NE(back.verdict, MotionVerdict::free);
      ASSERT_TRUE(interference(Posed(fixed.binaryTree()),
                               Posed(moving.binaryTree(), motion.at(first.time)), context))
          << n;
      ASSERT_TRUE(interference(Posed(fixed.binaryTree()),
                               Posed(moving.binaryTree(), motion.at(r.time)), context))
          << n;
      options.margin = 0.1;
      ASSERT_NE(certify(moving, fixed, motion, options, context).verdict, MotionVerdict::free) << n;
    }
  }
  std::cout << free << " free, " << contact << " contact, " << undecided << " undecided\n";
  EXPECT_GT(free, count / 10);
  EXPECT_GT(contact, count / 10);
  EXPECT_LE(undecided, 1 + count / 100'000);
}

// ---- former bugs ----

/// The closest points are 1e-163 apart, so their squared distance underflows. This once made the
/// direction infinite.
TEST(CertifyMotion, GapWhoseSquareUnderflows) {
  const double e = 1e-163;
  TriangleMesh a, b;
  add(a, Vec3(-e, -e, -e), Vec3(-1, -1, -0.5), Vec3(-1, -0.5, -1));
  add(b, Vec3(e, e, e), Vec3(1, 1, 0.5), Vec3(1, 0.5, 1));
  const Body fixed = bodyOf(a), moving = bodyOf(b);
  MotionOptions options;
  options.tolerance = 1e-7;
  QueryContext context;
  const RigidMotion through =
      RigidMotion::spatial(at(Vec3::Constant(0.5)), at(Vec3::Constant(-0.5)), {});
  EXPECT_NE(certify(moving, fixed, through, options, context).verdict, MotionVerdict::free);
}

/// Between large yaws the body must take the way round that is shorter in real arithmetic. A
/// remainder by 2π in double would give the longer way here: 2π in double is off by 2.4e-16, and
/// over 10^8 revolutions this error adds up to enough to decide which way is shorter.
TEST(CertifyMotion, LargeYawsTakeTheShorterWay) {
  const double yaw = 628318558.99229252;  // 3.141592647 rad plus whole revolutions
  const RigidMotion turn = RigidMotion::planar(Vec3::Zero(), Vec3(0, 0, yaw), {});
  EXPECT_FALSE(turn.ambiguous());
  EXPECT_NEAR(turn.at(1).m(0, 0), std::cos(yaw), 1e-14);
  EXPECT_NEAR(turn.at(1).m(1, 0), std::sin(yaw), 1e-14);
  EXPECT_GT(turn.at(0.5).m(1, 0), 0.99) << "counterclockwise";
}

/// One triangle is far larger than the other. Closest points are off by 1e-16 of the size of the
/// larger triangle. A direction computed from them is therefore tilted so much that the gap along
/// it is lost.
TEST(CertifyMotion, ClearanceOverTwiceTheToleranceIsFreeBesideLargeTriangles) {
  std::mt19937_64 random(test::testSeed(5));
  std::uniform_real_distribution<double> u(-1, 1);
  for (const double large : {10.0, 100.0, 1000.0})
    for (int i = 0; i < 200; ++i) {
      const double gap = 2.5e-7;
      const Eigen::Quaterniond q(u(random), u(random), u(random), u(random));
      const Mat3 R = q.normalized().toRotationMatrix();
      const Vec3 d(std::cos(0.1 * i), std::sin(0.1 * i), 0);
      TriangleMesh a, b;  // a has an edge at height 0, b an edge or a corner at height `gap`
      add(a, R * Vec3(-large, 0, 0), R * Vec3(0.7 * large, 0, 0),
          R * Vec3(u(random), u(random), i % 2 ? -1 : 0) * large);
      add(b, R * (-0.7 * d + gap * Vec3::UnitZ()),
          R * (0.6 * d + (i % 3 ? gap : 0.1) * Vec3::UnitZ()), R * Vec3(u(random), u(random), 1));
      const Body fixed = bodyOf(a), moving = bodyOf(b);
      MotionOptions options;
      options.tolerance = 1e-7;
      QueryContext context;
      const RigidMotion still = RigidMotion::spatial({}, {}, {});
      EXPECT_EQ(certify(moving, fixed, still, options, context).verdict, MotionVerdict::free)
          << large << ", " << i;
    }
}

/// Two convex meshes, whose distance is known from their exact hulls.
TEST(CertifyMotion, HullsKeepTheDistance) {
  std::mt19937_64 random(test::testSeed(71));
  std::normal_distribution<double> normal;
  const auto round = [&](int count) {
    std::vector<Vec3> points;
    for (int i = 0; i < count; ++i)
      points.push_back(Vec3(normal(random), normal(random), normal(random)).normalized());
    return Polytope(points);
  };
  const auto meshOf = [](const Polytope& p) {
    TriangleMesh mesh;
    mesh.vertices.assign(p.vertices().begin(), p.vertices().end());
    mesh.triangles.assign(p.faces().begin(), p.faces().end());
    return mesh;
  };
  const Polytope a = round(150), b = round(400);
  const Body fixed = bodyOf(meshOf(a)), moving = bodyOf(meshOf(b));
  ASSERT_TRUE(fixed.hull() && moving.hull());
  for (int n = 0; n < 200; ++n) {
    const Vec3 side = Vec3(normal(random), normal(random), normal(random)).normalized();
    const double angle = normal(random);
    const RigidPose pose = turned((2.001 + 0.02 * (n % 10)) * side, angle, Vec3(1, 2, 3));
    const Transform X{rotationMatrix(pose.q), pose.p};
    const double distance = convexDistance({a, {}}, {b, X}).distance;
    ASSERT_GT(distance, 0);
    MotionOptions options;
    options.tolerance = 1e-9;
    for (const double share : {1 - 1e-5, 1 + 1e-5}) {
      options.margin = share * distance;
      QueryContext context;
      EXPECT_EQ(
          certify(moving, fixed, RigidMotion::spatial(pose, pose, {}), options, context).verdict ==
              MotionVerdict::free,
          share < 1);
    }
  }
}

/// Hulls that decide many pairs count as work.
TEST(CertifyMotion, WorkLimitHoldsForHulls) {
  std::vector<Body> bodies;
  for (int i = 0; i < 50; ++i)
    bodies.push_back(bodyOf(box(Vec3(0.52, 0.1 * i, 0), Vec3(1, 0.1 * i + 0.2, 1))));
  const Body cube = bodyOf(box(Vec3(-0.5, 0, 0), Vec3(0.5, 5, 1)));
  std::vector<MotionPair> pairs;
  for (const Body& body : bodies) pairs.push_back({&body, &cube, 0});
  MotionOptions options;
  options.tolerance = 1e-9;
  options.workLimit = 10;
  QueryContext context;
  RigidEdge edge(RigidMotion::spatial(at(Vec3::Zero()), turned(Vec3::Zero(), 1e-3, {0, 0, 1}), {}));
  const MotionResult result = certifyMotion(edge, pairs, options, context);
  EXPECT_EQ(result.reason, UndecidedReason::workLimit);
  EXPECT_LE(context.counters.work(), 10u + 16 + 256);
  options.workLimit = kNoWorkLimit;
  EXPECT_EQ(certifyMotion(edge, pairs, options, context).verdict, MotionVerdict::free);
}

/// Tests of leaf pairs, and tests for contact at single poses, must count as work, too. The largest
/// value of the limit stands for no limit.
TEST(CertifyMotion, WorkLimitHoldsInLeavesAndProbes) {
  TriangleMesh many;
  for (int i = 0; i < 300; ++i) add(many, Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0));
  TriangleMesh other = many;
  for (Vec3& v : other.vertices) v = Vec3(v[0], 0.3, v[1] + 1e-4 - 0.3 * v[0]);
  const Body fixed = bodyOf(many), moving = bodyOf(other);
  MotionOptions options;
  options.tolerance = 1e-7;
  options.hulls = false;
  const RigidMotion motion =
      RigidMotion::spatial(at(Vec3(0, 0, 0.3)), turned(Vec3(0, 0, 0.4), 0.3, Vec3(1, 2, 3)), {});
  for (const TreeKind trees : {TreeKind::obb4, TreeKind::obbBinary, TreeKind::sphere})
    for (const std::uint64_t limit : {std::uint64_t{10}, std::uint64_t{1000}}) {
      SCOPED_TRACE(test::treeName(trees));
      QueryContext context;
      options.workLimit = limit;
      const MotionResult r =
          certify(moving, fixed, motion, options, context, {EdgeMethod::certified, trees});
      EXPECT_LE(context.counters.work(), limit + 16 + 256);
      EXPECT_EQ(r.reason, UndecidedReason::workLimit);
    }
  // A motion of zero length is not sampled, so the walk of the trees must end without a sampled
  // contact. A small star is in the corner of a large star; each has 300 triangles about one
  // centroid.
  TriangleMesh star, small;
  for (int i = 0; i < 150; ++i)
    for (const auto& [mesh, s] : {std::pair{&star, 1.0}, std::pair{&small, 0.0625}}) {
      add(*mesh, s * Vec3(-1, -1, 0), s * Vec3(2, -1, 0), s * Vec3(-1, 2, 0));
      add(*mesh, s * Vec3(-1, 0, -1), s * Vec3(2, 0, -1), s * Vec3(-1, 0, 2));
    }
  const Body large = bodyOf(star), tiny = bodyOf(small);
  const RigidMotion rest =
      RigidMotion::spatial(at(Vec3(0, 0.25, 0.25)), at(Vec3(0, 0.25, 0.25)), {});
  options.workLimit = 1000;
  for (const TreeKind trees : {TreeKind::obbBinary, TreeKind::sphere}) {
    QueryContext context;
    const MotionResult r =
        certify(tiny, large, rest, options, context, {EdgeMethod::certified, trees});
    EXPECT_EQ(r.reason, UndecidedReason::workLimit);
    EXPECT_LE(context.counters.work(), options.workLimit + 16);
  }
  QueryContext used;
  used.counters.boxTests = 5;
  options.workLimit = ~std::uint64_t{0};
  EXPECT_NE(certify(moving, fixed, motion, options, used).reason, UndecidedReason::workLimit);
}

/// The body hits a wall at t = 0.29, and at t = 3/4 a tip is within the tube. The second half
/// becomes undecided before the first half is divided. The query must then not claim that a part of
/// the first half is certified.
TEST(CertifyMotion, NothingIsClaimedOfUndividedIntervals) {
  TriangleMesh robot, tip, wall;
  add(robot, Vec3(-0.01, 0, 0), Vec3(0.01, 0, 0), Vec3(0, 0.01, 0));
  add(tip, Vec3(0.75, 0, -1e-9), Vec3(0.75, -1, -1), Vec3(0.75, 1, -1));
  add(wall, Vec3(0.3, -1, -1), Vec3(0.3, 1, -1), Vec3(0.3, 0, 1));
  const Body moving = bodyOf(robot), fixed[] = {bodyOf(tip), bodyOf(wall)};
  const MotionPair pairs[] = {{&fixed[0], &moving, 0, 0, 2}, {&fixed[1], &moving, 0, 1, 2}};
  for (const bool earliest : {false, true}) {
    MotionOptions options;
    options.tolerance = 1e-12;
    options.earliest = earliest;
    QueryContext context;
    RigidEdge edge(RigidMotion::spatial(at(Vec3::Zero()), at(Vec3::UnitX()), {1e-8, 0}));
    const MotionResult r = certifyMotion(edge, pairs, options, context);
    EXPECT_NE(r.verdict, MotionVerdict::free);
    EXPECT_LE(r.certifiedUntil, 0.29);
  }
}

/// The contact begins at a time at which one interval ends and the next interval begins. An
/// interval that ends at this time can never be proved.
TEST(CertifyMotion, ContactsThatBeginWithAnInterval) {
  const Body a = bodyOf(box(-0.5 * Vec3::Ones(), 0.5 * Vec3::Ones())),
             b = bodyOf(box(-0.5 * Vec3::Ones(), 0.5 * Vec3::Ones()));
  for (const EdgeMethod method :
       {EdgeMethod::certified, EdgeMethod::adaptive, EdgeMethod::advancement})
    for (const double clearanceSlack : {0.0, 1e-7})
      for (const bool earliest : {false, true})
        for (int k = 0; k <= 64; ++k) {
          QueryContext context;
          MotionOptions options;
          options.tolerance = 1e-7;
          options.clearanceSlack = clearanceSlack;
          options.earliest = earliest;
          const double from = -1 - 4 * (k / 64.0);  // the faces meet at −1
          const MotionResult r = certify(
              b, a,
              RigidMotion::spatial(at(Vec3(from, 0.3, 0.2)), at(Vec3(from + 4, 0.3, 0.2)), {}),
              options, context, method);
          ASSERT_EQ(r.verdict, MotionVerdict::contact)
              << k << "/64 by " << edgeMethodNames()[static_cast<std::size_t>(method)];
          if (!earliest) continue;
          EXPECT_LE(r.certifiedUntil, k / 64.0);
          EXPECT_GE(r.time, k / 64.0 - 1e-12);
          EXPECT_TRUE(r.grazing || r.time - r.certifiedUntil <= options.timeTolerance) << k;
        }
}

/// Many bodies are not separated in the interval of the whole motion; others are far away. Neither
/// walks of trees nor static samples may build a tree of a far body.
TEST(CertifyMotion, FarBodiesGetNoTree) {
  const Body mover = bodyOf(box(-0.5 * Vec3::Ones(), 0.5 * Vec3::Ones()));
  std::vector<Body> near, far;
  for (int i = 0; i < 12; ++i) near.push_back(bodyOf(box(Vec3(i, 1, -1), Vec3(i + 0.9, 1.1, 1))));
  for (int i = 0; i < 24; ++i) far.push_back(bodyOf(box(Vec3(1e3, i, 0), Vec3(1e3 + 1, i + 1, 1))));
  std::vector<MotionPair> pairs;
  for (const Body& body : near) pairs.push_back({&body, &mover, 0, pairs.size() + 1, 0});
  for (const Body& body : far) pairs.push_back({&body, &mover, 0, pairs.size() + 1, 0});
  RigidEdge edge(
      RigidMotion::spatial(at(Vec3::Zero()), turned(Vec3(12, 0.1, 0), 3, Vec3::UnitX()), {}));
  MotionOptions options;
  options.tolerance = 1e-7;
  QueryContext context;
  certifyMotion(edge, pairs, options, context);
  for (const Body& body : far) EXPECT_FALSE(body.treeBuilt());
}

/// The bounding sphere of the cube does not touch the wall, but the sphere is closer to the wall
/// than the margin.
TEST(CertifyMotion, AMarginLargerThanTheGapOfSpheres) {
  const Body wall = test::bodyOf(test::box(Vec3(-10, 1, -10), Vec3(10, 1.5, 10))),
             cube = test::bodyOf(test::box(Vec3(-0.1, -0.1, -0.1), Vec3(0.1, 0.1, 0.1)));
  const RigidMotion motion =
      RigidMotion::spatial(test::at(Vec3(0, 0, 0)), test::at(Vec3(0.01, 0, 0)), {});
  QueryContext context;
  MotionOptions options;
  options.tolerance = 1e-6;
  for (const test::Proof& proof :
       {test::Proof(EdgeMethod::certified), test::Proof(EdgeMethod::certified, TreeKind::rss),
        test::Proof(EdgeMethod::adaptive)}) {
    options.margin = 1;
    EXPECT_EQ(test::certify(cube, wall, motion, options, context, proof).verdict,
              MotionVerdict::contact);
    options.margin = 0.5;
    EXPECT_EQ(test::certify(cube, wall, motion, options, context, proof).verdict,
              MotionVerdict::free);
  }
}

}  // namespace
}  // namespace corridor
