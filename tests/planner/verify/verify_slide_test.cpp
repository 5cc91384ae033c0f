// Tests of polynomial curves of one joint, against closed forms.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/planner/verify/curve_oracle.h"
#include "tests/support/floating_point.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::CurveOracle;
using Real = CurveOracle::Real;

/// A ball of radius 0.125 on a slide along x, and a wall that begins at x = 1. The ball's position
/// is a polynomial, so distances are known in closed form.
struct Slide {
  KinematicTree tree;
  ConfigurationSpace space;
  ConvexPart ball{{Vec3::Zero()}, 0.125, false}, wall;
  PathProblem problem;

  explicit Slide(Coordinate::Kind kind = Coordinate::Kind::line, double multiplier = 1,
                 double offset = 0) {
    for (int i = 0; i < 8; ++i)
      wall.points.emplace_back(i & 1 ? 2 : 1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    Coordinate c;
    c.kind = kind;
    space.add(c);
    Frame slide;
    slide.joint = Frame::Joint::prismatic;
    slide.axis = Vec3::UnitX();
    slide.variable = 0;
    slide.multiplier = multiplier;
    slide.offset = offset;
    tree.add(slide);
    problem.tree = &tree;
    problem.space = &space;
    problem.tolerance = 1e-9;
    problem.tube = Configuration::Zero(1);
    problem.bodies = {{"ball", nullptr, {&ball, 1}, false, 1},
                      {"wall", nullptr, {&wall, 1}, false, 0}};
    problem.pairs = {{0, 1}};
  }
  Slide(const Slide&) = delete;
  static CurvePiece piece(std::vector<double> coefficients, double error = 0) {
    CurvePiece one;
    one.coefficients =
        Eigen::Map<Eigen::RowVectorXd>(coefficients.data(), Eigen::Index(coefficients.size()));
    one.error = Configuration::Constant(1, error);
    return one;
  }
  PathReport verify(const std::vector<CurvePiece>& pieces) const {
    return verifyCurve(problem, pieces);
  }
};

TEST(VerifyCurve, TurnsBackBeforeTheWall) {
  const Slide slide;
  // 4·h·τ(1 − τ) reaches h at τ = 1/2; the ball touches at h = 0.875.
  for (const double gap : {1e-2, 1e-5, 1e-8, 1e-11, 1e-13}) {
    const double h = 0.875 - gap;
    const PathReport report = slide.verify({Slide::piece({0, 2 * h, 0})});
    EXPECT_EQ(report.verdict, PathVerdict::proved) << gap;
    EXPECT_LE(report.provedClearance, 0.875 - h);
    EXPECT_LE(report.distanceQueries, 6000u);
  }
  const PathReport touching = slide.verify({Slide::piece({0, 2 * 0.875, 0})});
  EXPECT_EQ(touching.verdict, PathVerdict::refuted);
  EXPECT_NEAR(touching.findings.at(0).t, 0.5, 1e-6);
  EXPECT_EQ(touching.findings.at(0).reason, "contact");
  EXPECT_NEAR(touching.findings.at(0).configuration[0], 0.875, 1e-13);
}

/// The inner coefficients of the piece are far beyond the wall, and partly cancel.
TEST(VerifyCurve, LargeCoefficientsThatCancel) {
  const Slide slide;
  std::mt19937_64 random(test::testSeed(34));
  for (const double size : {10.0, 1e4, 1e8}) {
    for (const int n : {5, 8, 9}) {
      // The largest value of the curve, `most`, is found by a dense search.
      std::vector<double> d(static_cast<std::size_t>(n) + 1, 0.0);
      for (int k = 1; k < n; ++k) d[std::size_t(k)] = (k % 2 ? size : -size) * (1 + 0.01 * (n - k));
      const CurvePiece wild = Slide::piece(d);
      const CurveOracle oracle(slide.tree, wild);
      const Real most = -CurveOracle::least([&](Real t) { return -oracle.value(0, t); }, 2000);
      // The gaps exceed the rounding errors, which are those of the large terms.
      for (const double share : {1e-3, 1e-6, -1e-6, -1e-3}) {
        const double gap = share * std::max(1.0, 1e-4 * size);
        // With this offset of the joint, the ball is `gap` from the wall where the curve has its
        // largest value.
        const Slide placed(Coordinate::Kind::line, 1, static_cast<double>(0.875L - gap - most));
        const PathVerdict verdict = placed.verify({wild}).verdict;
        EXPECT_EQ(verdict, gap > 0 ? PathVerdict::proved : PathVerdict::refuted)
            << size << " " << n << " " << gap;
      }
    }
  }
}

TEST(VerifyCurve, AMimicWithANegativeMultiplier) {
  for (const auto kind : {Coordinate::Kind::line, Coordinate::Kind::circle}) {
    const Slide slide(kind, -2, 0.5);
    // x = 0.5 − 2q. With q down to −0.1875, the ball touches.
    const auto down = [](double q) { return Slide::piece({0, 2 * q, 0}); };
    EXPECT_EQ(slide.verify({down(-0.1875 + 1e-9)}).verdict, PathVerdict::proved);
    EXPECT_EQ(slide.verify({down(-0.1875)}).verdict, PathVerdict::refuted);
    EXPECT_EQ(slide.verify({down(-0.1875 - 1e-9)}).verdict, PathVerdict::refuted);
    EXPECT_EQ(slide.verify({down(5)}).verdict, PathVerdict::proved);
    // A coordinate of the kind `circle` does not jump at half a turn: its values along a piece are
    // used literally.
    EXPECT_EQ(slide.verify({Slide::piece({0, 9, 9})}).verdict, PathVerdict::proved);
  }
}

TEST(VerifyCurve, FirstContactInAPiece) {
  const Slide slide;
  // x = −1 + 3τ²: the ball touches at x = 0.875.
  const PathReport report =
      slide.verify({Slide::piece({-2, -1}), Slide::piece({-1, -1, 2}), Slide::piece({2, 0})});
  ASSERT_EQ(report.verdict, PathVerdict::refuted);
  EXPECT_EQ(report.edgesProved, 1);
  const PathFinding& finding = report.findings.at(0);
  const double truth = std::sqrt(1.875 / 3);
  EXPECT_EQ(finding.edge, 1);
  ASSERT_TRUE(finding.freeUntil);
  EXPECT_LE(*finding.freeUntil, truth);
  EXPECT_GE(finding.t, truth - 1e-15);
  EXPECT_LE(finding.t - *finding.freeUntil, 1e-8);
  EXPECT_EQ(finding.reason, "contact");
  EXPECT_NEAR(finding.configuration[0], 0.875, 1e-7);
}

TEST(VerifyCurve, PiecesMustJoin) {
  const Slide slide, circle(Coordinate::Kind::circle);
  const auto reason = [](const Slide& world, const std::vector<CurvePiece>& pieces) {
    const PathReport report = world.verify(pieces);
    return report.findings.empty() ? "" : report.findings[0].reason;
  };
  const double next = std::nextafter(-1.0, 0);
  EXPECT_EQ(reason(slide, {Slide::piece({-2, -1}), Slide::piece({-1, -2})}), "");
  EXPECT_EQ(reason(slide, {Slide::piece({-2, -1}), Slide::piece({next, -2})}), "jump");
  // Two pieces may be apart by the exact sum of their errors, but not by more.
  const double half = (next + 1) / 2;
  EXPECT_EQ(reason(slide, {Slide::piece({-2, -1}, half), Slide::piece({next, -2}, half)}), "");
  EXPECT_EQ(reason(slide, {Slide::piece({-2, -1}, half),
                           Slide::piece({next, -2}, std::nextafter(half, 0))}),
            "jump");
  EXPECT_EQ(reason(circle,
                   {Slide::piece({-4, -std::numbers::pi}), Slide::piece({-std::numbers::pi, -4})}),
            "");
  EXPECT_EQ(
      reason(circle, {Slide::piece({-4, -std::numbers::pi}), Slide::piece({std::numbers::pi, -4})}),
      "jump");
  const PathReport report =
      slide.verify({Slide::piece({-2, -1}), Slide::piece({-1.5, -2}), Slide::piece({-2, -1})});
  EXPECT_EQ(report.verdict, PathVerdict::refuted);
  ASSERT_EQ(report.findings.size(), 1u);
  EXPECT_EQ(report.findings[0].edge, 1);
  EXPECT_EQ(report.findings[0].configuration[0], -1.5);
  EXPECT_EQ(report.edgesProved, 2);
}

/// An error that is larger than the tolerance proves as a tube does, but refutes nothing.
TEST(VerifyCurve, ALargeErrorRefutesNothing) {
  const Slide slide;
  const auto at = [&](double h, double error) {
    return slide.verify({Slide::piece({0, 2 * h, 0}, error)});
  };
  EXPECT_EQ(at(0.8, 0.07).verdict, PathVerdict::proved);
  EXPECT_EQ(at(0.8, 0.08).verdict, PathVerdict::undecided);
  EXPECT_EQ(at(0.95, 0.2).verdict, PathVerdict::undecided);
  EXPECT_EQ(at(0.95, 0.2).findings.at(0).reason, "the error of the piece may exceed the clearance");
  EXPECT_EQ(at(0.95, 1e-10).verdict, PathVerdict::refuted);
  Slide tubed;
  tubed.problem.tube = Configuration::Constant(1, 0.05);
  EXPECT_EQ(tubed.verify({Slide::piece({0, 1.6, 0}, 0.02)}).verdict, PathVerdict::proved);
  EXPECT_EQ(tubed.verify({Slide::piece({0, 1.6, 0}, 0.03)}).verdict, PathVerdict::undecided);
}

/// A bar turns about a ball, at a constant gap. The number of intervals grows as 1/√gap only,
/// because directions of slabs turn with the bar.
TEST(VerifyCurve, ABarThatTurnsAboutABall) {
  KinematicTree tree;
  ConfigurationSpace space;
  space.add(Coordinate{});
  Frame turn;
  turn.joint = Frame::Joint::revolute;
  turn.variable = 0;
  tree.add(turn);
  const ConvexPart bar{{Vec3(-1, 0.5, 0), Vec3(1, 0.5, 0)}, 0.125, false};
  PathProblem problem;
  problem.tree = &tree;
  problem.space = &space;
  problem.tolerance = 1e-13;
  problem.tube = Configuration::Zero(1);
  problem.pairs = {{0, 1}};
  for (const double gap : {1e-3, 1e-5, 1e-7}) {
    const ConvexPart ball{{Vec3::Zero()}, 0.375 - gap, false};
    problem.bodies = {{"ball", nullptr, {&ball, 1}, false, 0},
                      {"bar", nullptr, {&bar, 1}, false, 1}};
    for (const CurvePiece& piece : {Slide::piece({0, 0.5}), Slide::piece({0, 0.25, 0.5})}) {
      const PathReport report = verifyCurve(problem, {&piece, 1});
      EXPECT_EQ(report.verdict, PathVerdict::proved) << gap;
      EXPECT_LE(report.provedClearance, gap * (1 + 1e-9));
      // About 4,000 of these queries refine the proved clearance.
      EXPECT_LE(static_cast<double>(report.distanceQueries), 5000 + 10 / std::sqrt(gap)) << gap;
    }
  }
}

/// The angle of a coordinate of the kind `circle` is used literally: the curve from 3 to 3 + 2π/3
/// is not the curve from 3 to 3 − 4π/3.
TEST(VerifyCurve, CirclesAreLiteral) {
  KinematicTree tree;
  ConfigurationSpace space;
  Coordinate c;
  c.kind = Coordinate::Kind::circle;
  space.add(c);
  Frame turn;
  turn.joint = Frame::Joint::revolute;
  turn.variable = 0;
  tree.add(turn);
  const ConvexPart rod{{Vec3(0.3, 0, 0), Vec3(1, 0, 0)}, 0.01, false},
      post{{Vec3(0.7 * std::cos(1.0), 0.7 * std::sin(1.0), 0)}, 0.01, false};
  PathProblem problem;
  problem.tree = &tree;
  problem.space = &space;
  problem.tolerance = 1e-9;
  problem.tube = Configuration::Zero(1);
  problem.bodies = {{"post", nullptr, {&post, 1}, false, 0}, {"rod", nullptr, {&rod, 1}, false, 1}};
  problem.pairs = {{0, 1}};
  const auto verdict = [&](std::vector<double> d) {
    const CurvePiece piece = Slide::piece(std::move(d));
    return verifyCurve(problem, {&piece, 1}).verdict;
  };
  EXPECT_EQ(verdict({3, 5, 7}), PathVerdict::proved);
  EXPECT_EQ(verdict({3, 5, 7.4}), PathVerdict::refuted);  // the rod meets the post at 1 + 2π
  EXPECT_EQ(verdict({3, 2, 0.5}), PathVerdict::refuted);
  EXPECT_EQ(verdict({3, 9.5, 7}), PathVerdict::refuted);  // the rod passes the post, and returns
  EXPECT_EQ(verdict({100, 100.5, 101}), PathVerdict::proved);  // from −0.53 to 0.47, modulo 2π
}

TEST(VerifyCurve, BadPieces) {
  const Slide slide;
  const auto verdictOf = [&](const CurvePiece& piece) { return slide.verify({piece}); };
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {infinity, std::nan("")})
    EXPECT_EQ(verdictOf(Slide::piece({0, bad, 0})).findings.at(0).reason, "not a valid state");
  EXPECT_THROW(slide.verify({}), std::invalid_argument);
  EXPECT_THROW(verdictOf(Slide::piece({0})), std::invalid_argument);
  EXPECT_THROW(verdictOf(Slide::piece(std::vector<double>(11, 0.0))), std::invalid_argument);
  EXPECT_THROW(verdictOf(Slide::piece({0, 0}, -1e-9)), std::invalid_argument);
  EXPECT_THROW(verdictOf(Slide::piece({0, 0}, infinity)), std::invalid_argument);
  CurvePiece wide = Slide::piece({0, 0});
  wide.error = Configuration::Zero(2);
  EXPECT_THROW(verdictOf(wide), std::invalid_argument);
  wide = {Eigen::MatrixXd::Zero(2, 2), Configuration::Zero(1)};
  EXPECT_THROW(verdictOf(wide), std::invalid_argument);
  EXPECT_EQ(verdictOf(Slide::piece(std::vector<double>(10, 0.0))).verdict, PathVerdict::proved);
}

/// In a floating-point mode in which no bound holds, every piece must be undecided. Flush-to-zero
/// changes no verdict.
TEST(VerifyCurve, OtherArithmeticIsRefused) {
  const Slide slide;
  const std::vector<CurvePiece> pieces = {Slide::piece({0, 1.7, 0}), Slide::piece({0, -1, 0.5}),
                                          Slide::piece({0.5, 0x1p-1060, 0})};
  const std::vector<CurvePiece> jump = {Slide::piece({0, 0x1p-1070}), Slide::piece({0, 0})};
  for (const auto& setting : test::floatingPointSettings()) {
    PathReport report, jumped;
    {
      const test::WithFloatingPoint set(setting);
      report = slide.verify(pieces);
      jumped = slide.verify(jump);
    }
    EXPECT_EQ(report.edges, 3);
    EXPECT_EQ(report.verdict, setting.standard() ? PathVerdict::proved : PathVerdict::undecided)
        << setting.name;
    EXPECT_EQ(jumped.verdict, setting.standard() ? PathVerdict::refuted : PathVerdict::undecided)
        << setting.name;
    EXPECT_EQ(report.findings.size(), setting.standard() ? 0u : 3u);
  }
}

}  // namespace
}  // namespace corridor
