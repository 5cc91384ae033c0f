// Tests of polynomial curves of arms, against an independent oracle that minimises distances
// (curve_oracle.h).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/planner/verify/curve_oracle.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::Arm;
using test::CurveOracle;
using test::randomPiece;
using Real = CurveOracle::Real;

/// An arm with every kind of joint. A rod is attached to the arm's tip, and a ball (`side`) to a
/// side branch, whose joint mimics another joint with a negative multiplier. Another ball (`ball`)
/// is at rest.
struct Grazing {
  Arm arm;
  Vec3 p, q;  ///< ends of the rod
  ConvexPart rod, side, ball;
  PathProblem problem;
  bool againstSide;  ///< whether the rod is tested against `side`; else against `ball`

  /// @param point whether the rod is only a ball.
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
  /// Returns the least distance, along a piece, of the centre of the tested ball from the rod's
  /// axis.
  Real least(const CurvePiece& piece) const {
    const CurveOracle oracle(arm.tree, piece);
    return CurveOracle::least([&](Real t) {
      return oracle.distance(arm.tip, p, q, againstSide ? arm.side : 0,
                             (againstSide ? side : ball).points[0], t);
    });
  }
  /// Sets the radius of the tested ball so that ball and rod are `gap` apart where they are
  /// closest. @returns the gap that results from the rounded radius.
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

/// Returns the halves of a piece. Rotations are halved, too, at the rounded middle of the slerp;
/// `error` covers the rounding.
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

/// Returns the same curve with one degree more. The coefficients are rounded; `error` covers the
/// rounding.
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
    // Six sizes of gaps are a round. The short version has two of them for each degree; three
    // degrees together have all six.
    const int rounds = test::casesOf(1, 40), step = rounds == 1 ? 3 : 1;
    for (int i = degree % step; i < rounds * 6; i += step) {
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
          EXPECT_LE(report.provedClearance, real + 1e-15L);
          EXPECT_GE(report.provedClearance, gap > 1e-5 ? 0.5 * gap : 0);
          EXPECT_GE(report.closestFound, real - 1e-15L);
        }
        ++cases;
      }
    }
  }
  EXPECT_GT(cases, 16);
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
    const CurvePiece piece = randomPiece(
        world.arm, 1, random);  // coordinates of the kind `circle` turn by less than half a turn
    world.setGap(world.least(piece), std::pow(10.0, -1 - i % 6) * (i % 4 < 2 ? 1 : -1));
    if (world.ball.radius < 0 || world.side.radius < 0) continue;
    const PathReport curve = world.verify({piece}),
                     edge = verifyPath(world.problem,
                                       {piece.coefficients.col(0), piece.coefficients.col(1)});
    EXPECT_EQ(curve.verdict, edge.verdict) << i;
    EXPECT_GE(curve.provedClearance, 0.6 * edge.provedClearance);
    EXPECT_GE(edge.provedClearance, 0.6 * curve.provedClearance);
    EXPECT_LE(static_cast<double>(curve.distanceQueries),
              1.1 * static_cast<double>(edge.distanceQueries) + 20);
    proved += curve.verdict == PathVerdict::proved;
    refuted += curve.verdict == PathVerdict::refuted;
  }
  EXPECT_GT(proved, 10);
  EXPECT_GT(refuted, 10);
}

/// The tube, the margin and the error of the piece each reduce the clearance.
TEST(VerifyCurve, TubeMarginAndErrorCount) {
  std::mt19937_64 random(test::testSeed(33));
  for (int i = 0; i < 20; ++i) {
    Grazing world(random, i % 2 == 1);
    world.problem.tolerance = 1e-7;
    CurvePiece piece = randomPiece(world.arm, 2 + i % 5, random);
    const Real least = world.least(piece);
    if (least < 0.3L) continue;
    world.setGap(least, 0.2);
    const double reach = 60;  // larger than the sum of the reach weights R_j
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

}  // namespace
}  // namespace corridor
