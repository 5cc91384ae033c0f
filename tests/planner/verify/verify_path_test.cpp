// Tests of paths with a clearance known in closed form, and of random paths against dense sampling.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planner/verify/exact_contact.h"
#include "tests/planner/verify/rigid_world.h"
#include "tests/support/floating_point.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::boxMesh;
using test::oneTriangle;
using test::poseOf;

constexpr double kPi = std::numbers::pi;

/// A body among obstacles. This class owns their meshes.
struct World {
  TriangleMesh body, obstacle;
  test::RigidWorld spatial{false}, planar{true};
  struct Settings {
    std::vector<VerifyBody> fixed;
    double margin = 0, tolerance = 1e-7;
    Tube tube;
    std::uint64_t workLimit = 2'000'000;
  } problem;

  World(TriangleMesh b, TriangleMesh o) : body(std::move(b)), obstacle(std::move(o)) {
    problem.fixed = {{"obstacle", &obstacle}};
  }
  World(const World&) = delete;
  PathReport verify(const std::vector<RigidPose>& states) { return verifyIn(spatial, states); }
  PathReport verify(const std::vector<Eigen::Vector3d>& states) { return verifyIn(planar, states); }

 private:
  template <class State>
  PathReport verifyIn(test::RigidWorld& world, const std::vector<State>& states) {
    world.moving = {{"body", &body}};
    world.fixed = problem.fixed;
    world.margin = problem.margin;
    world.tolerance = problem.tolerance;
    world.tube = problem.tube;
    world.workLimit = problem.workLimit;
    return test::verifyRigid(world, states);
  }
};
using Poses = std::vector<RigidPose>;
using PlanarPoses = std::vector<Eigen::Vector3d>;

const TriangleMesh kCube = boxMesh(Vec3(-0.5, -0.5, -0.5), Vec3(0.5, 0.5, 0.5));

TEST(VerifyPath, BoxPastAWall) {
  for (const double clearance : {0.25, 1e-2, 1e-3}) {
    World world(kCube, boxMesh(Vec3(-3, 0.5 + clearance, -1), Vec3(3, 2, 1)));
    const PathReport report = world.verify(Poses{poseOf({-5, 0, 0}), poseOf({5, 0, 0})});
    EXPECT_EQ(report.verdict, PathVerdict::proved);
    EXPECT_EQ(report.edgesProved, 1);
    EXPECT_TRUE(report.findings.empty());
    EXPECT_NEAR(report.closestFound, clearance, 1e-12);
    EXPECT_LE(report.provedClearance, clearance);
    // Refining ends at 90 % of the smallest distance met.
    EXPECT_GE(report.provedClearance, (clearance < 0.1 ? 0.6 : 0.89) * clearance);
  }
}

/// In a floating-point mode in which no bound holds, every edge must be undecided, and the report
/// must give this reason.
TEST(VerifyPath, OtherArithmeticIsRefused) {
  World world(boxMesh(Vec3(-1, -1, -1), Vec3(1, 1, 1)), boxMesh(Vec3(-9, 2, -9), Vec3(9, 3, 9)));
  const Poses path = {poseOf(Vec3(-5, 0, 0)), poseOf(Vec3(0, 0, 0)), poseOf(Vec3(5, 0, 0))};
  for (const auto& setting : test::floatingPointSettings()) {
    PathReport report;
    {
      const test::WithFloatingPoint set(setting);
      report = world.verify(path);
    }
    EXPECT_EQ(report.edges, 2);
    if (setting.standard()) {
      EXPECT_EQ(report.verdict, PathVerdict::proved) << setting.name;
      continue;
    }
    EXPECT_EQ(report.verdict, PathVerdict::undecided) << setting.name;
    EXPECT_EQ(report.edgesProved, 0);
    ASSERT_EQ(report.findings.size(), 2U);
    EXPECT_THAT(report.findings[0].reason,
                testing::HasSubstr(setting.shortExtended ? "does not keep 64 bits"
                                                         : "rounding is not to nearest"));
  }
}

TEST(VerifyPath, ExactTouchingIsRefuted) {
  World world(kCube, boxMesh(Vec3(-3, 0.5, -1), Vec3(3, 2, 1)));
  const PathReport report = world.verify(Poses{poseOf({-5, 0, 0}), poseOf({5, 0, 0})});
  EXPECT_EQ(report.verdict, PathVerdict::refuted);
  ASSERT_EQ(report.findings.size(), 1u);
  const PathFinding& finding = report.findings[0];
  EXPECT_EQ(finding.reason, "contact");
  EXPECT_EQ(finding.b, "body");
  EXPECT_EQ(finding.a, "obstacle");
  EXPECT_EQ(finding.edge, 0);
  EXPECT_EQ(finding.gap, 0);
  EXPECT_EQ(finding.point.y(), 0.5);
  EXPECT_EQ(report.provedClearance, 0);
  // The reported contact is exact at the reported pose, between the reported triangles.
  const auto corners = [](const TriangleMesh& mesh, std::uint32_t i) {
    return verify::Corners{mesh.corner(i, 0), mesh.corner(i, 1), mesh.corner(i, 2)};
  };
  EXPECT_TRUE(verify::exactContact(test::poseIn(finding.configuration),
                                   corners(world.body, finding.primitiveB),
                                   corners(world.obstacle, finding.primitiveA)));
}

TEST(VerifyPath, TouchingAtTheGoalIsRefuted) {
  World world(kCube, boxMesh(Vec3(1, -1, -1), Vec3(2, 1, 1)));
  const PathReport report =
      world.verify(Poses{poseOf({-5, 0, 0}), poseOf({-4, 0, 0}), poseOf({0.5, 0, 0})});
  EXPECT_EQ(report.verdict, PathVerdict::refuted);
  EXPECT_EQ(report.edgesProved, 1);
  ASSERT_EQ(report.findings.size(), 1u);
  EXPECT_EQ(report.findings[0].edge, 1);
  EXPECT_EQ(report.findings[0].t, 1);
  EXPECT_EQ(report.findings[0].reason, "contact");
}

TEST(VerifyPath, OneStateIsCheckedAsItIs) {
  World world(kCube, boxMesh(Vec3(1, -1, -1), Vec3(2, 1, 1)));
  PathReport report = world.verify(Poses{poseOf({0, 0, 0})});
  EXPECT_EQ(report.verdict, PathVerdict::proved);
  EXPECT_NEAR(report.provedClearance, 0.5, 1e-12);
  EXPECT_EQ(world.verify(Poses{poseOf({0.5, 0, 0})}).verdict, PathVerdict::refuted);
  EXPECT_EQ(world.verify(Poses{poseOf({0.5 - 1e-6, 0, 0})}).verdict, PathVerdict::proved);
}

// A blade of length 1 rotates past a point at radius 1 + gap. The closest pose is at a t that
// bisection doesn't hit. The middle pose is far from the point: a verifier that used only half of
// the reach weight R_j would wrongly prove paths with a negative gap at once.
TEST(VerifyPath, BladePastAPoint) {
  for (const double angle : {0.31, 0.77, 1.9}) {
    for (const double gap : {1e-1, 1e-3, 1e-4, 1e-5, 1e-6, -1e-6, -1e-5, -1e-4, -1e-3, -1e-1}) {
      const double r = 1 + gap;
      const Vec3 tip(r * std::cos(angle), r * std::sin(angle), 0);
      World world(oneTriangle({0, 0, 0}, {1, 0, 0}, {0.5, 0, 0}),
                  oneTriangle(tip, tip + Vec3(0, 0, 1), tip + Vec3(0, 0, -1)));
      const PathReport report = world.verify(Poses{poseOf({0, 0, 0}, 0), poseOf({0, 0, 0}, 2.8)});
      EXPECT_EQ(report.verdict, gap > 0 ? PathVerdict::proved : PathVerdict::undecided)
          << angle << " " << gap;  // at rounded poses two segments never meet exactly
      // A blade with a width meets the point.
      World wide(boxMesh({0, -1e-3, -0.1}, {1, 1e-3, 0.1}), world.obstacle);
      const PathReport second = wide.verify(Poses{poseOf({0, 0, 0}, 0), poseOf({0, 0, 0}, 2.8)});
      // the wide blade's corners reach sqrt(1 + 1e-6), 5e-7 farther
      EXPECT_EQ(second.verdict, gap > 6e-7 ? PathVerdict::proved : PathVerdict::refuted)
          << angle << " " << gap;
      if (gap > 0) {
        EXPECT_LE(report.provedClearance, gap * (1 + 1e-9));
        EXPECT_GE(report.provedClearance, 0.85 * gap - 2e-7);
      }
    }
  }
}

TEST(VerifyPath, TranslationsOfAWideEdgeAreNotJumped) {
  // The middle pose is 0.45 from the plate, which the body passes at a quarter of the way. With
  // half of the true motion bound, the path would be proved.
  World world(boxMesh(Vec3(-0.005, 0, 0), Vec3(0.005, 0.01, 0.01)),
              boxMesh(Vec3(-0.47, -1, -1), Vec3(-0.46, 1, 1)));
  const PathReport report = world.verify(Poses{poseOf({-0.9, 0, 0}), poseOf({0.9, 0, 0})});
  EXPECT_EQ(report.verdict, PathVerdict::refuted);
}

TEST(VerifyPath, ThinPlateIsNotJumped) {
  World world(kCube, boxMesh(Vec3(3.33, -5, -5), Vec3(3.3301, 5, 5)));
  world.body = boxMesh(Vec3(-0.01, -0.01, -0.01), Vec3(0.01, 0.01, 0.01));
  const PathReport report = world.verify(
      Poses{poseOf({0, 0, 0}), poseOf({-4, 0, 0}), poseOf({10, 0, 0}, 1), poseOf({11, 0, 0})});
  EXPECT_EQ(report.verdict, PathVerdict::refuted);
  EXPECT_EQ(report.edgesProved, 2);
  ASSERT_EQ(report.findings.size(), 1u);
  EXPECT_EQ(report.findings[0].edge, 1);
  EXPECT_NEAR(report.findings[0].point.x(), 3.33, 0.02);
  EXPECT_NEAR(report.findings[0].configuration[0], 3.33, 0.02);
}

// The blade rotates past a point 1e-12 beyond its tip, which cannot be decided, and then through a
// box. The box must refute the edge, whatever the order of the two obstacles.
TEST(VerifyPath, AnUndecidedPairHidesNoContact) {
  const Vec3 tip = (1 + 1e-12) * Vec3(std::cos(0.77), std::sin(0.77), 0);
  const TriangleMesh post = oneTriangle(tip, tip + Vec3(0, 0, 1), tip + Vec3(0, 0, -1));
  const TriangleMesh plate = boxMesh({0.43, 0.52, -1}, {0.53, 0.62, 1});
  const Poses path = {poseOf({0, 0, 0}, 0), poseOf({0, 0, 0}, 2.8)};
  for (const bool postFirst : {true, false}) {
    World world(oneTriangle({0, 0, 0}, {1, 0, 0}, {0.5, 0, 0}), postFirst ? post : plate);
    world.problem.tolerance = 1e-5;
    world.problem.fixed = {{"first", &world.obstacle}};
    EXPECT_EQ(world.verify(path).verdict,
              postFirst ? PathVerdict::undecided : PathVerdict::refuted);
    world.problem.fixed.push_back({"second", postFirst ? &plate : &post});
    const PathReport report = world.verify(path);
    EXPECT_EQ(report.verdict, PathVerdict::refuted);
    ASSERT_EQ(report.findings.size(), 1U);
    EXPECT_EQ(report.findings[0].a, postFirst ? "second" : "first");
    EXPECT_EQ(report.findings[0].reason, "contact");
    EXPECT_EQ(report.edgesProved, 0);
  }
}

// At the start, rotations within the tube may move the blade to the post. So this pair is undecided
// before any other is tested. Later the blade goes through a box, which refutes the edge.
TEST(VerifyPath, APairThatIsUndecidedAtTheStartHidesNoContact) {
  const TriangleMesh post = oneTriangle({0.9, 0.002, 0}, {0.9, 0.002, 1}, {0.9, 0.002, -1}),
                     plate = boxMesh({0.43, -0.62, -1}, {0.53, -0.52, 1});
  const Poses path = {poseOf({0, 0, 0}, 0), poseOf({0, 0, 0}, -2.8)};
  World world(oneTriangle({0, 0, 0}, {1, 0, 0}, {0.5, 0, 0}), post);
  world.problem.tube.rotation = 0.003;
  EXPECT_EQ(world.verify(path).verdict, PathVerdict::undecided);
  for (const bool postFirst : {true, false}) {
    world.problem.fixed = {{"post", &post}, {"plate", &plate}};
    if (!postFirst) std::swap(world.problem.fixed[0], world.problem.fixed[1]);
    const PathReport report = world.verify(path);
    EXPECT_EQ(report.verdict, PathVerdict::refuted) << postFirst;
    ASSERT_EQ(report.findings.size(), 1U);
    EXPECT_EQ(report.findings[0].a, "plate");
  }
}

// A body starts inside a solid. At the end of the edge, rotations within the tube may move it to
// the wall, so the end is undecided. The start refutes the edge.
TEST(VerifyPath, APairThatIsUndecidedAtTheEndIsTestedForContainmentAtTheStart) {
  World world(kCube, boxMesh(Vec3(-5, -5, -5), Vec3(5, 5, 5)));
  world.problem.tube.rotation = 0.01;
  const Poses path = {poseOf({0, 0, 0}), poseOf({4.499, 0, 0})};
  EXPECT_EQ(world.verify(path).verdict, PathVerdict::undecided);
  world.problem.fixed[0].solid = true;
  const PathReport report = world.verify(path);
  EXPECT_EQ(report.verdict, PathVerdict::refuted);
  ASSERT_EQ(report.findings.size(), 1U);
  EXPECT_EQ(report.findings[0].reason, "inside");
  EXPECT_EQ(report.findings[0].t, 0);
}

TEST(VerifyPath, RodThroughASlot) {
  // A rod slides through a square hole of edge 0.2 in a plate, with 1 % play: first parallel to the
  // axis of the hole, then slightly tilted.
  World world(boxMesh(Vec3(-1, -0.099, -0.099), Vec3(1, 0.099, 0.099)),
              boxMesh(Vec3(-0.05, 0.1, -1), Vec3(0.05, 1, 1)));
  const TriangleMesh below = boxMesh(Vec3(-0.05, -1, -1), Vec3(0.05, -0.1, 1));
  const TriangleMesh left = boxMesh(Vec3(-0.05, -0.1, -1), Vec3(0.05, 0.1, -0.1));
  const TriangleMesh right = boxMesh(Vec3(-0.05, -0.1, 0.1), Vec3(0.05, 0.1, 1));
  for (const TriangleMesh* part : {&below, &left, &right}) {
    world.problem.fixed.push_back({"part", part});
  }
  PathReport report = world.verify(Poses{poseOf({-3, 0, 0}), poseOf({3, 0, 0})});
  EXPECT_EQ(report.verdict, PathVerdict::proved);
  EXPECT_NEAR(report.closestFound, 0.001, 1e-12);
  EXPECT_GE(report.provedClearance, 0.0006);
  // Tilted by 0.03 about z, the rod rises by 0.05·tan 0.03 > 0.001 inside the plate, whose half
  // thickness is 0.05.
  report = world.verify(
      Poses{poseOf({-3, 0, 0}, 0.03, Vec3::UnitZ()), poseOf({3, 0, 0}, 0.03, Vec3::UnitZ())});
  EXPECT_EQ(report.verdict, PathVerdict::refuted);
  ASSERT_EQ(report.findings.size(), 1u);
  EXPECT_THAT(report.findings[0].a, testing::AnyOf("part", "obstacle"));
}

TEST(VerifyPath, MarginJustBelowAndAboveTheClearance) {
  World world(kCube, boxMesh(Vec3(-3, 0.75, -1), Vec3(3, 2, 1)));
  const std::vector<RigidPose> path = {poseOf({-0.002, 0, 0}), poseOf({0.003, 0, 0})};
  world.problem.margin = 0.25 - 1e-6;
  const PathReport report = world.verify(path);
  EXPECT_EQ(report.verdict, PathVerdict::proved);
  EXPECT_GE(report.provedClearance, world.problem.margin);
  for (const double margin : {0.25, 0.25 + 1e-6}) {
    world.problem.margin = margin;
    const PathReport violated = world.verify(path);
    EXPECT_EQ(violated.verdict, PathVerdict::refuted);
    ASSERT_EQ(violated.findings.size(), 1u);
    EXPECT_EQ(violated.findings[0].reason, "closer than the margin");
    EXPECT_EQ(violated.findings[0].gap, 0.25);
  }
}

TEST(VerifyPath, TubeLargerThanTheClearanceIsNotProved) {
  World world(kCube, boxMesh(Vec3(-3, 0.75, -1), Vec3(3, 2, 1)));
  const std::vector<RigidPose> path = {poseOf({-5, 0, 0}), poseOf({5, 0, 0})};
  const auto verdict = [&](double position, double rotation, double margin) {
    world.problem.tube = {position, rotation};
    world.problem.margin = margin;
    return world.verify(path).verdict;
  };
  // The tube displaces x, y and z, but only y counts.
  EXPECT_EQ(verdict(0.249, 0, 0), PathVerdict::proved);
  for (const bool obstaclesFirst : {false, true}) {  // in problem files, links come first
    world.spatial.obstaclesFirst = obstaclesFirst;
    EXPECT_EQ(verdict(0.25, 0, 0), PathVerdict::refuted);  // displaced by 0.25, the body touches
    EXPECT_EQ(world.verify(path).findings.at(0).reason,
              "a deviation within the tube comes too close");
  }
  // A rotation by τ lifts the corner (1, 1, 1)/2 by sin τ/√2 − (1 − cos τ)/2. The bound for it is
  // τ/√2 + √0.75 τ²/2.
  EXPECT_EQ(verdict(0, 0.2985, 0), PathVerdict::proved);
  EXPECT_NE(verdict(0, 0.432, 0), PathVerdict::proved);
  EXPECT_EQ(verdict(0.049, 0.1, 0.12), PathVerdict::proved);
  EXPECT_NE(verdict(0.065, 0.1, 0.12), PathVerdict::proved);
  // The proved clearance holds for the whole tube.
  world.problem.tube = {0.1, 0};
  world.problem.margin = 0;
  const PathReport report = world.verify(path);
  EXPECT_LE(report.provedClearance, 0.15);
  EXPECT_GE(report.provedClearance, 0.07);
}

// The tube of a planar body displaces the body only in the plane, so a body above a floor stays
// above the floor.
TEST(VerifyPath, PlanarTubesDoNotRefuteThroughTheFloor) {
  const TriangleMesh floor = boxMesh({-9, -9, -1}, {9, 9, 0}),
                     wall = boxMesh({-9, 0.501, 0.1}, {9, 1, 1});
  World world(boxMesh({-0.5, -0.5, 0.001}, {0.5, 0.5, 1}), floor);
  world.problem.tube = {0.002, 0};
  const PlanarPoses path = {{-1, 0, 0}, {1, 0, 0}};
  EXPECT_EQ(world.verify(path).verdict, PathVerdict::proved);
  world.problem.fixed = {{"wall", &wall}};
  EXPECT_EQ(world.verify(path).verdict, PathVerdict::refuted);
  world.problem.fixed = {};
  EXPECT_EQ(world.verify(path).verdict, PathVerdict::proved);
}

TEST(VerifyPath, PlanarGoesTheShorterWayRound) {
  // From 3 to −3 through π, the blade never points to +x, where the first obstacle is.
  const TriangleMesh blade = boxMesh(Vec3(0, -0.01, -0.1), Vec3(1, 0.01, 0.1));
  World front(blade, boxMesh(Vec3(0.9, -0.1, -1), Vec3(1.1, 0.1, 1)));
  World back(blade, boxMesh(Vec3(-1.1, -0.01, -1), Vec3(-0.9, 0.01, 1)));
  using Planar = std::vector<Eigen::Vector3d>;
  const Planar path = {{0, 0, 3}, {0, 0, -3}};
  EXPECT_EQ(front.verify(path).verdict, PathVerdict::proved);
  const PathReport report = back.verify(path);
  EXPECT_EQ(report.verdict, PathVerdict::refuted);
  ASSERT_EQ(report.findings.size(), 1u);
  EXPECT_NEAR(std::abs(report.findings[0].configuration[2]), kPi, 0.1);
  // Angles outside of [−π, π] define the same poses.
  EXPECT_EQ(front.verify(Planar{{0, 0, 3 + 20 * kPi}, {0, 0, -3 - 8 * kPi}}).verdict,
            PathVerdict::proved);
  EXPECT_EQ(front.verify(Planar{{0, 0, 3}, {0, 0, 1}, {0, 0, -1}}).verdict, PathVerdict::refuted);
  // A planar body stays at z = 0, and its tube does not displace it along z.
  World above(kCube, boxMesh(Vec3(-3, -3, 0.6), Vec3(3, 3, 1)));
  above.problem.tube.position = 0.099 / std::sqrt(2);
  EXPECT_EQ(above.verify(Planar{{-1, 0, 0}, {1, 0, 1}}).verdict, PathVerdict::proved);
}

TEST(VerifyPath, HalfTurnsAreAmbiguous) {
  World world(kCube, boxMesh(Vec3(5, 5, 5), Vec3(6, 6, 6)));
  const auto reason = [](const PathReport& report) {
    return report.findings.empty() ? "" : report.findings[0].reason;
  };
  for (const double offset : {0.0, 9e-10, -9e-10}) {
    EXPECT_EQ(reason(world.verify(PlanarPoses{{0, 0, 1}, {0, 0, 1 + kPi + offset}})),
              "ambiguous half turn");
    const PathReport report =
        world.verify(Poses{poseOf({0, 0, 0}), poseOf({1, 0, 0}, kPi + offset, Vec3(1, 2, 3))});
    EXPECT_EQ(reason(report), "ambiguous half turn");
    EXPECT_EQ(report.verdict, PathVerdict::refuted);
  }
  for (const double offset : {1.1e-9, -1.1e-9}) {
    EXPECT_EQ(reason(world.verify(PlanarPoses{{0, 0, 1}, {0, 0, 1 + kPi + offset}})), "");
    EXPECT_EQ(reason(world.verify(
                  Poses{poseOf({0, 0, 0}), poseOf({1, 0, 0}, kPi + offset, Vec3(1, 2, 3))})),
              "");
  }
  // q and −q are the same rotation.
  RigidPose negative = poseOf({1, 0, 0}, 0.1);
  negative.q.coeffs() *= -2.5;
  EXPECT_EQ(world.verify(Poses{poseOf({0, 0, 0}), negative}).verdict, PathVerdict::proved);
}

TEST(VerifyPath, SlidingAlongAWallNeedsFewQueries) {
  // The gap of 1e-9 is a hundredth of the tolerance, but nothing moves towards the wall.
  World world(kCube, boxMesh(Vec3(-3, 0.5 + 1e-9, -1), Vec3(3, 2, 1)));
  const PathReport report = world.verify(Poses{poseOf({-5, 0, 0}), poseOf({5, 0, 0})});
  EXPECT_EQ(report.verdict, PathVerdict::proved);
  EXPECT_LE(report.provedClearance, 1e-9);
  EXPECT_LE(report.distanceQueries, 200u);
}

// A rod with 1 % play slides through its hole and tilts. The number of intervals must grow with the
// root of length over clearance, not with length over clearance.
TEST(VerifyPath, AnInsertionTakesFewIntervals) {
  World world(boxMesh(Vec3(-1, -0.099, -0.099), Vec3(1, 0.099, 0.099)),
              boxMesh(Vec3(-0.05, 0.1, -1), Vec3(0.05, 1, 1)));
  const TriangleMesh below = boxMesh(Vec3(-0.05, -1, -1), Vec3(0.05, -0.1, 1));
  world.problem.fixed.push_back({"below", &below});
  const PathReport report =
      world.verify(Poses{poseOf({-0.1, 0, 0}, -0.005), poseOf({0.1, 0, 0}, 0.005)});
  EXPECT_EQ(report.verdict, PathVerdict::proved);
  EXPECT_LE(report.distanceQueries, 4000u);
}

TEST(VerifyPath, GapUnderTheToleranceIsUndecided) {
  // A blade of length 1 rotates past a point 1e-12 beyond its tip.
  const double angle = 0.77, r = 1 + 1e-12;
  const Vec3 tip(r * std::cos(angle), r * std::sin(angle), 0);
  World world(oneTriangle({0, 0, 0}, {1, 0, 0}, {0.5, 0, 0}),
              oneTriangle(tip, tip + Vec3(0, 0, 1), tip + Vec3(0, 0, -1)));
  const Poses path = {poseOf({0, 0, 0}, 0), poseOf({0, 0, 0}, 2.8)};
  world.problem.tolerance = 1e-5;
  const PathReport report = world.verify(path);
  EXPECT_EQ(report.verdict, PathVerdict::undecided);
  ASSERT_EQ(report.findings.size(), 1u);
  EXPECT_EQ(report.findings[0].reason, "clearance below the tolerance");
  EXPECT_LT(report.findings[0].gap, 1e-5);
  world.problem.workLimit = 10;
  EXPECT_EQ(world.verify(path).findings.at(0).reason, "work limit reached");
}

TEST(VerifyPath, BadStatesAndProblems) {
  World world(kCube, boxMesh(Vec3(5, 5, 5), Vec3(6, 6, 6)));
  RigidPose zero, infinite;
  zero.q.coeffs().setZero();
  infinite.p.x() = std::numeric_limits<double>::infinity();
  for (const RigidPose& bad : {zero, infinite}) {
    const PathReport report = world.verify(Poses{RigidPose{}, RigidPose{}, bad});
    EXPECT_EQ(report.verdict, PathVerdict::refuted);
    ASSERT_EQ(report.findings.size(), 1u);
    EXPECT_EQ(report.findings[0].edge, 1);
    EXPECT_EQ(report.findings[0].reason, "not a valid state");
  }
  EXPECT_THROW(world.verify(Poses{}), std::invalid_argument);
  world.problem.margin = -1;
  EXPECT_THROW(world.verify(Poses{RigidPose{}}), std::invalid_argument);
  world.problem.margin = 0;
  world.problem.tube.rotation = std::nan("");
  EXPECT_THROW(world.verify(Poses{RigidPose{}}), std::invalid_argument);
  world.problem.tube.rotation = 0;
  world.problem.fixed.clear();
  const PathReport report = world.verify(Poses{RigidPose{}, poseOf({1, 0, 0})});
  EXPECT_EQ(report.verdict, PathVerdict::proved);
  EXPECT_EQ(report.provedClearance, std::numeric_limits<double>::infinity());
}

/// Returns the smallest distance over `samples` + 1 evenly spaced poses. The distance at each pose
/// comes from verifying the pose as a single state.
double sampledDistance(World& world, const RigidPose& from, const RigidPose& to, int samples) {
  double smallest = std::numeric_limits<double>::infinity();
  const Eigen::Quaterniond q0 = from.q.normalized(), q1 = to.q.normalized();
  for (int i = 0; i <= samples; ++i) {
    const double t = static_cast<double>(i) / samples;
    const RigidPose pose{from.p + t * (to.p - from.p), q0.slerp(t, q1)};
    smallest = std::min(smallest, world.verify(Poses{pose}).closestFound);
  }
  return smallest;
}

TEST(VerifyPath, RandomPathsAgainstDenseSampling) {
  std::mt19937_64 random(test::testSeed(4));
  const int paths = test::casesOf(12, 400);
  int proved = 0, refuted = 0;
  for (int i = 0; i < paths; ++i) {
    World world(test::randomSoup(random, 8, 0.3, 0.2), test::randomSoup(random, 30, 1.5, 0.2));
    for (Vec3& v : world.body.vertices) v += Vec3(0.4, 0, 0);  // the reference point is outside
    RigidPose from = test::randomPose(random, 1.5), to = test::randomPose(random, 1.5);
    const PathReport report = world.verify(Poses{from, to});
    const double sampled = sampledDistance(world, from, to, 400);
    if (report.verdict == PathVerdict::proved) {
      ++proved;
      EXPECT_GE(sampled, report.provedClearance) << i;
      EXPECT_GE(report.closestFound, report.provedClearance) << i;
    } else {
      refuted += report.verdict == PathVerdict::refuted;
    }
    if (sampled == 0) {
      EXPECT_EQ(report.verdict, PathVerdict::refuted) << i;
    }
    // The reversed path is the same curve.
    EXPECT_EQ(world.verify(Poses{to, from}).verdict, report.verdict) << i;
  }
  EXPECT_GT(proved, paths / 10);
  EXPECT_GT(refuted, paths / 10);
  EXPECT_GE(proved + refuted, paths - 1);
}

}  // namespace
}  // namespace corridor
