// Pairs of bodies that never move relative to each other (PathProblem::heldPairs). The expected
// distances follow from the shapes: balls and boxes at known places.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/planner/verify/rigid_world.h"

namespace corridor {
namespace {

using test::boxMesh;

constexpr double kRadius = 0.1;

/// A turret that turns about z, a ball on a held joint of the turret, 1 m out, and a lamp that is
/// fixed to the turret. A second held joint lifts a crane beside the turret; it stands on the
/// world.
struct Turret {
  KinematicTree tree;
  ConfigurationSpace space;
  std::vector<ConvexPart> parts;
  TriangleMesh box;
  PathProblem problem;

  /// @param lamp the distance of the lamp's centre from the turret's axis, m. @param crane the
  /// height of the crane's ball above the ground at z = 0.
  explicit Turret(double lamp, double crane = 1) {
    Coordinate turn;
    turn.name = "turn";
    turn.lower = -3;
    turn.upper = 3;
    space.add(turn);
    Frame turret, arm, mast;
    turret.joint = Frame::Joint::revolute;
    turret.variable = 0;
    arm.parent = tree.add(turret);
    arm.joint = Frame::Joint::revolute;  // held: it has no variable, only an offset
    arm.offset = -M_PI / 2;
    arm.axis = Vec3::UnitZ();
    arm.fixed.p = Vec3(0, 1, 0);
    const std::size_t held = tree.add(arm);
    mast.joint = Frame::Joint::prismatic;
    mast.axis = Vec3::UnitZ();
    mast.offset = crane;
    mast.fixed.p = Vec3(-5, 0, 0);
    const std::size_t lifted = tree.add(mast);
    // The held joint turns (0, 1, 0) to (1, 0, 0): the ball is at (1, 1, 0) of the turret.
    parts = {{{Vec3(0, 1, 0)}, kRadius, false},
             {{Vec3(lamp, 1, 0)}, kRadius, false},
             {{Vec3::Zero()}, kRadius, false},
             {{Vec3(0, 0, 3)}, kRadius, false}};
    box = boxMesh(Vec3(-9, -9, -1), Vec3(9, 9, 0));
    problem.tree = &tree;
    problem.space = &space;
    problem.tolerance = 1e-8;
    problem.tube = Configuration::Zero(1);
    problem.bodies = {{"ball", nullptr, {&parts[0], 1}, false, held},
                      {"lamp", nullptr, {&parts[1], 1}, false, 1},
                      {"crane", nullptr, {&parts[2], 1}, false, lifted},
                      {"ground", &box, {}, false, 0},
                      {"sky", nullptr, {&parts[3], 1}, false, 0}};
    problem.pairs = {{0, 4}};  // far apart
    problem.heldPairs = {{0, 1}, {2, 3}};
  }
  Turret(const Turret&) = delete;

  PathReport report() const {
    return verifyPath(problem, {Configuration::Constant(1, -1), Configuration::Constant(1, 0),
                                Configuration::Constant(1, 1)});
  }
  PathReport curveReport() const {
    CurvePiece piece{Eigen::MatrixXd(1, 2), Configuration::Constant(1, 1e-6)};
    piece.coefficients << -1, 1;
    return verifyCurve(problem, std::vector<CurvePiece>{piece});
  }
};

TEST(HeldPairs, AreDecidedOnceForAllStates) {
  for (const double gap : {1e-1, 1e-6, -1e-6, -1e-2}) {
    SCOPED_TRACE(gap);
    const Turret turret(1 + 2 * kRadius + gap);
    for (const PathReport& report : {turret.report(), turret.curveReport()}) {
      EXPECT_EQ(report.verdict, gap > 0 ? PathVerdict::proved : PathVerdict::refuted);
      EXPECT_EQ(report.edgesProved, gap > 0 ? report.edges : 0);
      if (gap > 0) {
        // The closest of `pairs` are the ball and the sky, 3 m above the turret's centre.
        EXPECT_TRUE(report.findings.empty());
        EXPECT_NEAR(report.closestFound, std::sqrt(9 + 2) - 2 * kRadius, 1e-9);
        EXPECT_GT(report.provedClearance, 2.5);
        continue;
      }
      ASSERT_EQ(report.findings.size(), 1u);
      const PathFinding& finding = report.findings[0];
      EXPECT_TRUE(finding.inEveryState);
      EXPECT_EQ(finding.a, "ball");
      EXPECT_EQ(finding.b, "lamp");
      EXPECT_EQ(finding.reason, "contact");
      EXPECT_EQ(finding.edge, 0);
      EXPECT_EQ(finding.t, 0);
      EXPECT_FALSE(finding.freeUntil);
      EXPECT_EQ(report.provedClearance, 0);
    }
  }
}

TEST(HeldPairs, KeepMarginAndPadding) {
  Turret turret(1 + 2 * kRadius + 0.01);
  turret.problem.margin = 0.009;
  EXPECT_EQ(turret.report().verdict, PathVerdict::proved);
  turret.problem.margin = 0.011;
  ASSERT_EQ(turret.report().findings.size(), 1u);
  EXPECT_EQ(turret.report().findings[0].reason, "closer than the margin");
  EXPECT_NEAR(turret.report().findings[0].gap, 0.01, 1e-9);
  turret.problem.margin = 0.009;
  turret.problem.heldPairs[0].padding = 0.002;
  ASSERT_EQ(turret.report().findings.size(), 1u);
  EXPECT_EQ(turret.report().findings[0].reason, "closer than margin and padding");
  EXPECT_NEAR(turret.report().findings[0].required, 0.011, 1e-12);
}

TEST(HeldPairs, OfTheWorldAndAHeldJoint) {
  EXPECT_EQ(Turret(2, 2 * kRadius).report().verdict, PathVerdict::proved);
  const Turret low(2, 0.5 * kRadius);
  const PathReport report = low.report();
  EXPECT_EQ(report.verdict, PathVerdict::refuted);
  ASSERT_EQ(report.findings.size(), 1u);
  EXPECT_EQ(report.findings[0].a, "crane");
  EXPECT_EQ(report.findings[0].b, "ground");
  EXPECT_LT((report.findings[0].point - Vec3(-5, 0, 0)).norm(), kRadius);
}

TEST(HeldPairs, InsideASolidMesh) {
  Turret turret(2, -0.5);
  EXPECT_EQ(turret.report().verdict, PathVerdict::proved) << "the box is a surface";
  turret.problem.bodies[3].solid = true;
  ASSERT_EQ(turret.report().findings.size(), 1u);
  EXPECT_EQ(turret.report().findings[0].reason, "inside");
  EXPECT_TRUE(turret.report().findings[0].inEveryState);
}

TEST(HeldPairs, WithTooLittleClearanceAreUndecided) {
  Turret turret(1 + 2 * kRadius + 1e-5);
  turret.problem.tolerance = 1e-4;
  turret.problem.margin = 1e-5;
  const PathReport report = turret.report();
  ASSERT_EQ(report.findings.size(), 1u);
  EXPECT_NE(report.verdict, PathVerdict::proved);
  EXPECT_EQ(report.edgesProved, 0);
}

/// A path that touches something else, too, has both findings.
TEST(HeldPairs, ComeBeforeTheFindingsOfEdges) {
  Turret turret(1);
  turret.parts[3].points[0] = Vec3(std::sqrt(2.0), 0, 0);  // on the ball's circle
  const PathReport report = turret.report();
  ASSERT_GE(report.findings.size(), 2u);
  EXPECT_TRUE(report.findings[0].inEveryState);
  EXPECT_FALSE(report.findings[1].inEveryState);
  EXPECT_EQ(report.findings[1].b, "sky");
  EXPECT_TRUE(report.findings[1].freeUntil.has_value());
}

TEST(HeldPairs, NeedBodiesThatDoNotMove) {
  Turret turret(2);
  turret.problem.heldPairs = {{0, 4}};
  try {
    turret.report();
    ADD_FAILURE() << "the turret moves the ball against the sky";
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(std::string(error.what()),
              "verifyPath: a pair of heldPairs has a joint that moves between its bodies");
  }
  turret.problem.heldPairs = {{0, 7}};
  EXPECT_THROW(turret.report(), std::invalid_argument);
  turret.problem.heldPairs = {{0, 1, -1}};
  EXPECT_THROW(turret.report(), std::invalid_argument);
}

}  // namespace
}  // namespace corridor
