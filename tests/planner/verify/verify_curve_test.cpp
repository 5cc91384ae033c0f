// Tests of polynomial curves: against closed forms and against a minimising oracle of its own.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/planner/verify/curve_oracle.h"
#include "tests/support/floating_point.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::Arm;
using test::CurveOracle;
using test::randomPiece;
using Real = CurveOracle::Real;

constexpr double kPi = std::numbers::pi;

/// An arm with every kind of joint. A rod moves with its tip, and a ball with its side branch,
/// whose joint mimics one of the arm's with a negative multiplier. A ball rests.
struct Grazing {
  Arm arm;
  Vec3 p, q;  ///< ends of the rod
  ConvexPart rod, side, ball;
  PathProblem problem;
  bool againstSide;  ///< the rod against the side branch; else against the ball at rest

  /// @param point the rod is a ball.
  Grazing(std::mt19937_64& random, bool side_, bool point = false)
      : arm(random),
        p(test::randomVec(random, 0.2)),
        q(point ? p : test::randomVec(random, 0.2)),
        rod{{p, q}, 0.05, false},
        side{{test::randomVec(random, 0.1)}, 0.01, false},
        ball{{test::randomVec(random, 1.5)}, 0.01, false},
        againstSide(side_) {
    problem.tree = &arm.tree;
    problem.space = &arm.space;
    problem.tolerance = 1e-13;
    problem.tube = Configuration::Zero(static_cast<Eigen::Index>(arm.space.size()));
    problem.bodies = {{"rod", nullptr, {&rod, 1}, false, arm.tip},
                      {"side", nullptr, {&side, 1}, false, arm.side},
                      {"ball", nullptr, {&ball, 1}, false, 0}};
    problem.pairs = {againstSide ? VerifyPair{0, 1} : VerifyPair{2, 0}};
  }
  Grazing(const Grazing&) = delete;
  /// The least distance of the other body's centre from the rod's axis.
  Real least(const CurvePiece& piece) const {
    const CurveOracle oracle(arm.tree, piece);
    return CurveOracle::least([&](Real t) {
      return oracle.distance(arm.tip, p, q, againstSide ? arm.side : 0,
                             (againstSide ? side : ball).points[0], t);
    });
  }
  /// Sets the radius of the other body so that the bodies are `gap` apart where they are closest.
  /// @returns the gap with the rounded radius.
  Real setGap(Real leastDistance, double gap) {
    ConvexPart& other = againstSide ? side : ball;
    other.radius = static_cast<double>(leastDistance - Real(rod.radius) - Real(gap));
    return leastDistance - Real(rod.radius) - Real(other.radius);
  }
  PathReport verify(const std::vector<CurvePiece>& pieces) const {
    return verifyCurve(problem, pieces);
  }
};

CurvePiece reversed(const CurvePiece& piece) {
  return {piece.coefficients.rowwise().reverse(), piece.error};
}

/// The halves of a piece. Rotations are halved, too: the slerp's middle, rounded, with an error.
std::vector<CurvePiece> halves(const Arm& arm, const CurvePiece& piece) {
  CurvePiece left = piece, right = piece;
  const int n = piece.degree();
  for (int k = 1; k <= n; ++k) {
    for (int i = 0; i + k <= n; ++i)
      right.coefficients.col(i) = (right.coefficients.col(i) + right.coefficients.col(i + 1)) / 2;
    left.coefficients.col(k) = right.coefficients.col(0);
  }
  for (const Coordinate& c : arm.space.coordinates()) {
    if (c.kind != Coordinate::Kind::rotation) continue;
    const auto row = static_cast<Eigen::Index>(c.first);
    Eigen::Vector4d a = piece.coefficients.block<4, 1>(row, 0).normalized(),
                    b = piece.coefficients.block<4, 1>(row, n).normalized();
    if (a.dot(b) < 0) b = -b;
    right.coefficients.block<4, 1>(row, n) = piece.coefficients.block<4, 1>(row, n);
    left.coefficients.block<4, 1>(row, n) = right.coefficients.block<4, 1>(row, 0) = a + b;
    left.error[row] = right.error[row] = 0x1p-48;
  }
  return {left, right};
}

/// The same curve with one degree more. The coefficients are rounded, which `error` covers.
CurvePiece elevated(const Arm& arm, const CurvePiece& piece) {
  const int n = piece.degree() + 1;
  CurvePiece up = piece;
  up.coefficients.resize(piece.coefficients.rows(), n + 1);
  up.coefficients.col(0) = piece.coefficients.col(0);
  for (int i = 1; i < n; ++i)
    up.coefficients.col(i) =
        (piece.coefficients.col(i - 1) * i + piece.coefficients.col(i) * (n - i)) / n;
  up.coefficients.col(n) = piece.coefficients.col(n - 1);
  for (const Coordinate& c : arm.space.coordinates())
    if (c.kind != Coordinate::Kind::rotation)
      up.error[static_cast<Eigen::Index>(c.first)] =
          0x1p-50 *
          piece.coefficients.row(static_cast<Eigen::Index>(c.first)).cwiseAbs().maxCoeff();
  return up;
}

/// The obstacle's size is chosen so that the bodies just miss or just meet each other where they
/// are closest, at any time. The verdict is then known. The same holds for the reversed curve.
TEST(VerifyCurve, GrazingByConstruction) {
  std::mt19937_64 random(test::testSeed(30));
  int cases = 0;
  for (int degree = 1; degree <= 9; ++degree) {
    const int rounds = test::isStressRun() ? 40 : 1;
    for (int i = 0; i < rounds * 6; ++i) {
      Grazing world(random, i % 2 == 1, i % 6 >= 2);
      const double size = std::pow(10.0, -2 * (i % 6 + 1));
      // A short motion for the smallest gaps: the rounding is 2^-49 of all lengths, ways included.
      const CurvePiece piece = randomPiece(world.arm, degree, random, size < 1e-9 ? 0.125 : 1);
      const Real least = world.least(piece);
      if (least < 0.1L) continue;
      for (const double gap : {size, -size}) {
        const Real real = world.setGap(least, gap);
        const PathReport report = world.verify({i % 4 < 2 ? piece : reversed(piece)});
        ASSERT_EQ(report.verdict, gap > 0 ? PathVerdict::proved : PathVerdict::refuted)
            << "degree " << degree << ", gap " << gap << ", "
            << (report.findings.empty() ? "" : report.findings[0].reason);
        if (gap > 0) {
          EXPECT_LE(report.provenClearance, real + 1e-15L);
          EXPECT_GE(report.provenClearance, gap > 1e-5 ? 0.5 * gap : 0);
          EXPECT_GE(report.smallestDistanceMet, real - 1e-15L);
        }
        ++cases;
      }
    }
  }
  EXPECT_GT(cases, 50);
}

/// Halving and degree elevation leave the curve as it is, up to errors that are far below the gap.
TEST(VerifyCurve, OtherFormsOfACurveHaveItsVerdict) {
  std::mt19937_64 random(test::testSeed(31));
  for (int i = 0; i < 14; ++i) {
    Grazing world(random, i % 2 == 1, i % 7 >= 3);
    world.problem.tolerance = 1e-12;
    const CurvePiece piece = randomPiece(world.arm, 1 + i % 8, random);
    const Real least = world.least(piece);
    if (least < 0.1L) continue;
    const double size = std::pow(10.0, -2 - i % 7);
    for (const double gap : {size, -size}) {
      world.setGap(least, gap);
      const PathVerdict verdict = gap > 0 ? PathVerdict::proved : PathVerdict::refuted;
      const std::vector<CurvePiece> two = halves(world.arm, piece);
      EXPECT_EQ(world.verify(two).verdict, verdict) << gap;
      EXPECT_EQ(world.verify({elevated(world.arm, piece)}).verdict, verdict) << gap;
      EXPECT_EQ(world.verify({two[0], elevated(world.arm, two[1])}).verdict, verdict) << gap;
      EXPECT_EQ(world.verify({reversed(two[1]), reversed(two[0])}).verdict, verdict) << gap;
      if (gap > 0) {
        EXPECT_EQ(world.verify({two[0], two[0]}).findings.at(0).reason, "jump");
      }
    }
  }
}

TEST(VerifyCurve, AStraightPieceIsTheEdge) {
  std::mt19937_64 random(test::testSeed(32));
  int proved = 0, refuted = 0;
  for (int i = 0; i < 60; ++i) {
    Grazing world(random, i % 2 == 1);
    world.problem.tolerance = 1e-9;
    const CurvePiece piece = randomPiece(world.arm, 1, random);  // circles: below half a turn
    world.setGap(world.least(piece), std::pow(10.0, -1 - i % 6) * (i % 4 < 2 ? 1 : -1));
    if (world.ball.radius < 0 || world.side.radius < 0) continue;
    const PathReport curve = world.verify({piece}),
                     edge = verifyPath(world.problem,
                                       {piece.coefficients.col(0), piece.coefficients.col(1)});
    EXPECT_EQ(curve.verdict, edge.verdict) << i;
    EXPECT_GE(curve.provenClearance, 0.6 * edge.provenClearance);
    EXPECT_GE(edge.provenClearance, 0.6 * curve.provenClearance);
    EXPECT_LE(static_cast<double>(curve.distanceQueries),
              1.1 * static_cast<double>(edge.distanceQueries) + 20);
    proved += curve.verdict == PathVerdict::proved;
    refuted += curve.verdict == PathVerdict::refuted;
  }
  EXPECT_GT(proved, 10);
  EXPECT_GT(refuted, 10);
}

/// The tube, the margin and the error of the piece each take their share of the clearance.
TEST(VerifyCurve, TubeMarginAndErrorCount) {
  std::mt19937_64 random(test::testSeed(33));
  for (int i = 0; i < 20; ++i) {
    Grazing world(random, i % 2 == 1);
    world.problem.tolerance = 1e-7;
    CurvePiece piece = randomPiece(world.arm, 2 + i % 5, random);
    const Real least = world.least(piece);
    if (least < 0.3L) continue;
    world.setGap(least, 0.2);
    const double reach = 60;  // exceeds the sum of all R_j
    const auto all = [&](double share) { return Configuration::Constant(10, 0.2 * share / reach); };
    EXPECT_EQ(world.verify({piece}).verdict, PathVerdict::proved);
    for (const bool error : {false, true}) {
      (error ? piece.error : world.problem.tube) = all(0.7);
      const PathReport report = world.verify({piece});
      EXPECT_EQ(report.verdict, PathVerdict::proved);
      world.problem.margin = 0.05;
      EXPECT_EQ(world.verify({piece}).verdict, PathVerdict::proved);
      world.problem.margin = 0.21;
      EXPECT_NE(world.verify({piece}).verdict, PathVerdict::proved);
      world.problem.margin = 0;
      piece.error = world.problem.tube = all(0);
    }
    world.problem.margin = 0.2 - 1e-7;
    EXPECT_EQ(world.verify({piece}).verdict, PathVerdict::proved);
    world.problem.margin = 0.2 + 1e-7;
    EXPECT_EQ(world.verify({piece}).findings.at(0).reason, "closer than the margin");
  }
}

/// A ball of radius 0.1 on a slide along x, and a wall from x = 1 on. The ball's path is
/// polynomial: all is known in closed form.
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
    EXPECT_LE(report.provenClearance, 0.875 - h);
    EXPECT_LE(report.distanceQueries, 6000u);
  }
  const PathReport touching = slide.verify({Slide::piece({0, 2 * 0.875, 0})});
  EXPECT_EQ(touching.verdict, PathVerdict::refuted);
  EXPECT_NEAR(touching.findings.at(0).t, 0.5, 1e-6);
  EXPECT_EQ(touching.findings.at(0).reason, "contact");
  EXPECT_NEAR(touching.findings.at(0).configuration[0], 0.875, 1e-13);
}

/// The piece is at its wildest between the coefficients' ends: they are far beyond the wall, and
/// cancel.
TEST(VerifyCurve, LargeCoefficientsThatCancel) {
  const Slide slide;
  std::mt19937_64 random(test::testSeed(34));
  for (const double size : {10.0, 1e4, 1e8}) {
    for (const int n : {5, 8, 9}) {
      // The curve shrinks to [0, 1] times a height that is known by a dense search.
      std::vector<double> d(static_cast<std::size_t>(n) + 1, 0.0);
      for (int k = 1; k < n; ++k) d[std::size_t(k)] = (k % 2 ? size : -size) * (1 + 0.01 * (n - k));
      const CurvePiece wild = Slide::piece(d);
      const CurveOracle oracle(slide.tree, wild);
      const Real most = -CurveOracle::least([&](Real t) { return -oracle.value(0, t); }, 2000);
      // The rounding is that of the large terms.
      for (const double share : {1e-3, 1e-6, -1e-6, -1e-3}) {
        const double gap = share * std::max(1.0, 1e-4 * size);
        // The offset of the joint places the largest value.
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
    // A circle does not jump at half a turn: its value is literal.
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
  // The sum of the errors, exactly.
  const double half = (next + 1) / 2;
  EXPECT_EQ(reason(slide, {Slide::piece({-2, -1}, half), Slide::piece({next, -2}, half)}), "");
  EXPECT_EQ(reason(slide, {Slide::piece({-2, -1}, half),
                           Slide::piece({next, -2}, std::nextafter(half, 0))}),
            "jump");
  EXPECT_EQ(reason(circle, {Slide::piece({-4, -kPi}), Slide::piece({-kPi, -4})}), "");
  EXPECT_EQ(reason(circle, {Slide::piece({-4, -kPi}), Slide::piece({kPi, -4})}), "jump");
  const PathReport report =
      slide.verify({Slide::piece({-2, -1}), Slide::piece({-1.5, -2}), Slide::piece({-2, -1})});
  EXPECT_EQ(report.verdict, PathVerdict::refuted);
  ASSERT_EQ(report.findings.size(), 1u);
  EXPECT_EQ(report.findings[0].edge, 1);
  EXPECT_EQ(report.findings[0].configuration[0], -1.5);
  EXPECT_EQ(report.edgesProved, 2);
}

TEST(VerifyCurve, RotationsMustJoin) {
  std::mt19937_64 random(test::testSeed(35));
  Grazing world(random, false);
  world.ball = {{Vec3(99, 0, 0)}, 0.01, false};
  CurvePiece first = randomPiece(world.arm, 3, random), second = reversed(first);
  EXPECT_EQ(world.verify({first, second}).verdict, PathVerdict::proved);
  Eigen::Index row = 0;
  for (const Coordinate& c : world.arm.space.coordinates())
    if (c.kind == Coordinate::Kind::rotation) row = static_cast<Eigen::Index>(c.first);
  second.coefficients.block<4, 1>(row, 0) *= -3;  // the same rotation
  EXPECT_EQ(world.verify({first, second}).verdict, PathVerdict::proved);
  // Turned by 1e-6 rad. A rotation's error is an angle.
  const Eigen::Quaterniond q(Eigen::Vector4d(second.coefficients.block<4, 1>(row, 0)));
  second.coefficients.block<4, 1>(row, 0) =
      (q * Eigen::Quaterniond(Eigen::AngleAxisd(1e-6, Vec3::UnitX()))).coeffs();
  EXPECT_EQ(world.verify({first, second}).findings.at(0).reason, "jump");
  second.error[row] = 1.01e-6;
  EXPECT_EQ(world.verify({first, second}).verdict, PathVerdict::proved);
  second.error[row] = 0.99e-6;
  EXPECT_EQ(world.verify({first, second}).findings.at(0).reason, "jump");
  // Half a turn within a piece.
  first.coefficients.block<4, 1>(row, 0) = Eigen::Vector4d(0, 0, 0, 1);
  first.coefficients.block<4, 1>(row, 3) = Eigen::Vector4d(0, 1, 0, 0);
  EXPECT_EQ(world.verify({first}).findings.at(0).reason, "ambiguous half turn");
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
      EXPECT_LE(report.provenClearance, gap * (1 + 1e-9));
      // About 4,000 refine the proved clearance.
      EXPECT_LE(static_cast<double>(report.distanceQueries), 5000 + 10 / std::sqrt(gap)) << gap;
    }
  }
}

/// A circle turns literally: the curve from 3 to 3 + 2π/3 differs from that from 3 to 3 − 4π/3.
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
  EXPECT_EQ(verdict({3, 5, 7.4}), PathVerdict::refuted);  // meets the post at 1 + 2π
  EXPECT_EQ(verdict({3, 2, 0.5}), PathVerdict::refuted);
  EXPECT_EQ(verdict({3, 9.5, 7}), PathVerdict::refuted);       // past the post, and back
  EXPECT_EQ(verdict({100, 100.5, 101}), PathVerdict::proved);  // 0.47 to 1.47 − 0.5…
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
