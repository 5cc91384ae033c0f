// Tests of shortening in the plane, whose curves have closed forms.
#include "planner/solve/shorten_curve.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "planner/solve/curve_measure.h"
#include "planner/trajectory/curve_pieces.h"
#include "tests/planner/solve/plane_curves.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

CurvePiece pieceOf(const std::vector<Configuration>& coefficients) {
  CurvePiece piece;
  piece.coefficients.resize(coefficients[0].size(), static_cast<Eigen::Index>(coefficients.size()));
  for (std::size_t i = 0; i < coefficients.size(); ++i)
    piece.coefficients.col(static_cast<Eigen::Index>(i)) = coefficients[i];
  piece.error = Configuration::Zero(coefficients[0].size());
  return piece;
}

TEST(CurveRuler, MeasuresALine) {
  const ConfigurationSpace space = lines(2);
  const CurveRuler ruler(space, place(2, 1), place(1, 1));
  const MeasuredPiece line = ruler.of(pieceOf({place(0, 0), place(6, 4)}));
  EXPECT_NEAR(line.time, 4, 1e-12);  // 4 m at 1 m/s; 6 m at 2 m/s take 3 s
  EXPECT_NEAR(line.length, 5, 1e-12);
  EXPECT_NEAR(line.bend, 0, 1e-20);
  EXPECT_NEAR(ruler.timeOf(place(-6, 4)), 4, 1e-12);
}

/// A line has no curvature, whatever its parameter.
TEST(CurveRuler, DoesNotDependOnTheParameter) {
  const ConfigurationSpace space = lines(2);
  const MeasuredPiece line =
      CurveRuler(space, {}, {})
          .of(pieceOf({place(0, 0), place(0.5, 1), place(0.75, 1.5), place(2, 4)}));
  EXPECT_NEAR(line.length, std::sqrt(20.0), 0.01 * line.length);
  EXPECT_NEAR(line.bend, 0, 1e-12);
}

/// y = x² from −1 to 1: κ = 2/(1 + 4x²)^(3/2), and ∫κ² ds = ∫ 4(1 + 4x²)^(−5/2) dx.
TEST(CurveRuler, MeasuresAParabola) {
  const ConfigurationSpace space = lines(2);
  const MeasuredPiece parabola =
      CurveRuler(space, {}, {}).of(pieceOf({place(-1, 1), place(0, -1), place(1, 1)}));
  const double u = 2, root = std::sqrt(1 + u * u);
  const double bend = 2 * 2 * (u / root - u * u * u / (3 * root * root * root));
  EXPECT_NEAR(parabola.bend, bend, 0.03 * bend);  // twelve points
  EXPECT_NEAR(parabola.length, root + std::asinh(u) / 2, 0.01 * parabola.length);
}

/// From rest to rest along 8 m, in two pieces: with a = 1 m/s² it takes 2·√8 s, and with v = 1 m/s
/// in addition, 9 s.
TEST(CurveRuler, EstimatesTheTimeOfALine) {
  const ConfigurationSpace space = lines(1);
  const auto number = [](double x) { return Configuration(Configuration::Constant(1, x)); };
  const auto timeOf = [&](double velocity, double angle) {
    const CurveRuler ruler(space, number(velocity), number(1));
    const MeasuredPiece a = ruler.of(pieceOf({number(0), number(3)})),
                        b = ruler.of(pieceOf({number(3), number(8)}));
    return ruler.along({&a, &b}, {angle}).time;
  };
  EXPECT_NEAR(timeOf(HUGE_VAL, 0), 2 * std::sqrt(8.0), 0.02 * 2 * std::sqrt(8.0));
  EXPECT_NEAR(timeOf(1, 0), 9, 0.02 * 9);
  EXPECT_NEAR(timeOf(1, 1), 4 + 6, 0.02 * 10);  // with a stop between the pieces
}

/// On a circle with the radius 1 m, and with a = 1 m/s² for x and y, the speed is at most 1 m/s.
TEST(CurveRuler, EstimatesTheTimeOfACircle) {
  const ConfigurationSpace space = lines(2);
  const CurveRuler ruler(space, place(HUGE_VAL, HUGE_VAL), place(1, 1));
  // The quarters of the circle are cubics, whose radius is off by up to 3·10^-4.
  const double k = 4.0 / 3 * (std::sqrt(2.0) - 1);
  std::vector<MeasuredPiece> pieces;
  for (int quarter = 0; quarter < 12; ++quarter) {
    const double angle = M_PI / 2 * quarter;
    const Eigen::Rotation2Dd turn(angle);
    const auto at = [&](double x, double y) {
      const Eigen::Vector2d p = turn * Eigen::Vector2d(x, y);
      return place(p.x(), p.y());
    };
    pieces.push_back(ruler.of(pieceOf({at(1, 0), at(1, k), at(k, 1), at(0, 1)})));
  }
  std::vector<const MeasuredPiece*> all;
  for (const MeasuredPiece& piece : pieces) all.push_back(&piece);
  const double time = ruler.along(all, std::vector<double>(11, 0)).time;
  EXPECT_GT(time, 6 * M_PI);  // three turns at 1 m/s; starting and stopping take additional time
  EXPECT_LT(time, 6 * M_PI + 2.5);
}

TEST(CurveRuler, SeparatesCornersFromRounding) {
  const ConfigurationSpace space = lines(2);
  const CurveRuler ruler(space, place(2, 2), place(4, 4));
  EXPECT_NEAR(ruler.angleBetween(place(3, 0), place(0, 7)), M_PI / 2, 1e-12);
  EXPECT_EQ(ruler.angleBetween(place(3, 0), place(5, 1e-9)), 0);
}

std::vector<CurvePiece> polyline(const Path& path) {
  const ConfigurationSpace space = lines(2);
  return curveOfPath(space, path).pieces;
}

/// If nothing is in the way, the shortest curve is the straight line.
TEST(ShortenCurve, IsStraightIfAllIsFree) {
  const ConfigurationSpace space = lines(2);
  const Path path = {place(0, 0), place(1, 2), place(2, -1), place(4, 0)};
  for (const Smoothing goal : {Smoothing::time, Smoothing::length, Smoothing::acceleration}) {
    SmoothOptions options;
    options.goal = goal;
    const ShortCurve curve = shortenedCurve(space, polyline(path), kAllFree, options);
    ASSERT_EQ(curve.pieces.size(), 1u);
    EXPECT_EQ(curve.replaced, 1u);
    for (int i = 0; i <= 5; ++i)
      EXPECT_NEAR((curve.pieces[0].coefficients.col(i) - place(0.8 * i, 0)).norm(), 0, 1e-12);
  }
}

double valueOf(const ConfigurationSpace& space, const std::vector<CurvePiece>& pieces,
               Smoothing goal) {
  const CurveRuler ruler(space, {}, {});
  std::vector<MeasuredPiece> measured;
  std::vector<const MeasuredPiece*> all;
  for (const CurvePiece& piece : pieces) measured.push_back(ruler.of(piece));
  for (const MeasuredPiece& piece : measured) all.push_back(&piece);
  std::vector<double> angles;
  for (std::size_t k = 0; k + 1 < pieces.size(); ++k)
    angles.push_back(
        ruler.angleBetween(derivative(pieces[k], 1, 1), derivative(pieces[k + 1], 1, 0)));
  return ruler.along(all, angles).valueFor(goal);
}

double curvature(const CurvePiece& piece, double tau) {
  const Configuration v = derivative(piece, 1, tau), a = derivative(piece, 2, tau);
  return (v[0] * a[1] - v[1] * a[0]) / std::pow(v.norm(), 3);
}

/// Random ways around discs. The shortened curve is free, has the same ends, and has continuous
/// tangents and curvatures. Its objective is not above the objective of the curve with rounded
/// corners.
TEST(ShortenCurve, GoesAroundDiscs) {
  const ConfigurationSpace space = lines(2);
  std::mt19937_64 random(test::testSeed(87));
  const auto real = [&] { return std::uniform_real_distribution(-1.0, 1.0)(random); };
  double shares[3] = {};
  std::size_t replaced = 0;
  constexpr int kPaths = 20;
  for (int n = 0; n < kPaths; ++n) {
    Path path = {place(0, 0)};
    for (int k = 0; k < 6; ++k) path.push_back(path.back() + place(1 + 0.5 * real(), 2 * real()));
    std::vector<std::pair<Configuration, double>> discs;
    for (int k = 0; k < 60; ++k) {
      const Configuration centre = place(3 + 4 * real(), 4 * real());
      double room = 1;
      for (std::size_t i = 0; i + 1 < path.size(); ++i) {
        const Configuration edge = path[i + 1] - path[i];
        const double t = std::clamp((centre - path[i]).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
        room = std::min(room, (centre - path[i] - t * edge).norm());
      }
      if (room > 0.1) discs.emplace_back(centre, room - 0.05);
    }
    std::size_t tests = 0;
    const CurveTest isFree = [&](const CurvePiece& piece, double) {
      ++tests;
      for (int i = 0; i <= 200; ++i) {
        const Configuration q = configurationAt(space, piece, i / 200.0);
        for (const auto& [centre, radius] : discs)
          if ((q - centre).norm() < radius) return false;
      }
      return true;
    };
    const std::vector<CurvePiece> rounded = smoothedPath(space, path, isFree).pieces;
    int which = 0;
    for (const Smoothing goal : {Smoothing::time, Smoothing::length, Smoothing::acceleration}) {
      SmoothOptions options;
      options.goal = goal;
      tests = 0;
      const ShortCurve curve = shortenedCurve(space, rounded, isFree, options);
      EXPECT_EQ(curve.tests, tests);
      replaced += curve.replaced;
      const auto& pieces = curve.pieces;
      EXPECT_EQ(Configuration(pieces.front().coefficients.col(0)), path.front());
      EXPECT_EQ(Configuration(pieces.back().coefficients.rightCols<1>()), path.back());
      for (std::size_t k = 0; k < pieces.size(); ++k) ASSERT_TRUE(isFree(pieces[k], 0)) << n;
      for (std::size_t k = 0; k + 1 < pieces.size(); ++k) {
        const CurvePiece &a = pieces[k], &b = pieces[k + 1];
        ASSERT_EQ(Configuration(a.coefficients.rightCols<1>()),
                  Configuration(b.coefficients.col(0)));
        EXPECT_LT((derivative(a, 1, 1).normalized() - derivative(b, 1, 0).normalized()).norm(),
                  1e-9);
        EXPECT_NEAR(curvature(a, 1), curvature(b, 0), 1e-6);
      }
      const double share = valueOf(space, pieces, goal) / valueOf(space, rounded, goal);
      EXPECT_LE(share, 1) << n << wordOf(goal);
      shares[which++] += share / kPaths;
      const ShortCurve again = shortenedCurve(space, rounded, isFree, options);
      ASSERT_EQ(again.pieces.size(), pieces.size());
      for (std::size_t k = 0; k < pieces.size(); ++k)
        ASSERT_EQ(again.pieces[k].coefficients, pieces[k].coefficients);
    }
  }
  EXPECT_GT(replaced, 3u * kPaths);
  EXPECT_LT(shares[0], 0.95);  // time
  EXPECT_LT(shares[1], 0.98);  // length
  EXPECT_LT(shares[2], 0.7);   // acceleration
}

TEST(ShortenCurve, RemovesStops) {
  const ConfigurationSpace space = lines(2);
  const Path path = {place(0, 0), place(1, 0), place(1, 1)};
  // Nothing may come near the line from the start to the goal, except at its ends.
  const CurveTest isFree = [&](const CurvePiece& piece, double) {
    for (int i = 1; i < 100; ++i) {
      const Configuration q = configurationAt(space, piece, i / 100.0);
      if (q[0] - q[1] < 0.4 * std::sin(M_PI * (q[0] + q[1]) / 2)) return false;
    }
    return true;
  };
  const ShortCurve curve = shortenedCurve(space, polyline(path), isFree);
  EXPECT_GE(curve.replaced, 1u);
  for (std::size_t k = 0; k + 1 < curve.pieces.size(); ++k)
    EXPECT_LT((derivative(curve.pieces[k], 1, 1).normalized() -
               derivative(curve.pieces[k + 1], 1, 0).normalized())
                  .norm(),
              1e-9);
}

/// If a corner stays at an end of a part that is replaced, the stop at this corner is still counted
/// in the objective. So a replacement never makes the objective larger.
TEST(ShortenCurve, CountsCornersThatStay) {
  const ConfigurationSpace space = lines(2);
  const Path path = {place(0, 0), place(4, 0), place(4, 6), place(9, 6), place(9, 12)};
  for (const double width : {0.05, 0.2, 0.6}) {
    // Curves are free only within a distance of the path; the corner at (4, 0) can't be rounded.
    const CurveTest isFree = [&](const CurvePiece& piece, double) {
      for (int i = 0; i <= 300; ++i) {
        const Configuration q = configurationAt(space, piece, i / 300.0);
        double nearest = HUGE_VAL;
        for (std::size_t k = 0; k + 1 < path.size(); ++k) {
          const Configuration edge = path[k + 1] - path[k];
          const double t = std::clamp((q - path[k]).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
          nearest = std::min(nearest, (q - path[k] - t * edge).norm());
        }
        if (nearest > width || ((q - path[1]).norm() < 1 && nearest > 1e-5)) return false;
      }
      return true;
    };
    const std::vector<CurvePiece> rounded = smoothedPath(space, path, isFree).pieces;
    for (const Smoothing goal : {Smoothing::time, Smoothing::length, Smoothing::acceleration}) {
      SmoothOptions options;
      options.goal = goal;
      const std::vector<CurvePiece> shorter =
          shortenedCurve(space, rounded, isFree, options).pieces;
      EXPECT_LE(valueOf(space, shorter, goal), valueOf(space, rounded, goal) * (1 + 1e-9))
          << wordOf(goal) << ", width " << width;
    }
  }
}

TEST(ShortenCurve, StaysWithinBounds) {
  const ConfigurationSpace space = lines(2, 1);
  const Path path = {place(-1, 0), place(0, 1), place(1, 0), place(0, -1), place(-1, -0.5)};
  const CurveTest isFree = [&](const CurvePiece& piece, double) {  // not through the middle
    for (int i = 0; i <= 100; ++i)
      if (configurationAt(space, piece, i / 100.0).norm() < 0.5) return false;
    return true;
  };
  const ShortCurve curve = shortenedCurve(space, polyline(path), isFree);
  EXPECT_GE(curve.replaced, 1u);
  for (const CurvePiece& piece : curve.pieces)
    EXPECT_LE(piece.coefficients.cwiseAbs().maxCoeff(), 1);
}

TEST(ShortenCurve, EndsAtOnceIfStopped) {
  const ConfigurationSpace space = lines(2);
  const Path path = {place(0, 0), place(1, 0), place(1, 1)};
  const ShortCurve curve = shortenedCurve(space, polyline(path), kAllFree, {}, [] { return true; });
  EXPECT_EQ(curve.tests, 0u);
  EXPECT_EQ(curve.pieces.size(), 2u);
}

/// A part in which a rotation changes is not replaced; the parts before and after it are replaced.
TEST(ShortenCurve, LeavesRotationsThatMove) {
  ConfigurationSpace space = lines(2);
  Coordinate rotation;
  rotation.kind = Coordinate::Kind::rotation;
  rotation.name = "turn";
  CoordinateGroup group;
  group.coordinates.push_back(space.add(rotation));
  space.addGroup(group);
  const auto q = [](double x, double y, double angle) {
    Configuration c(6);
    c << x, y, 0, 0, std::sin(angle / 2), std::cos(angle / 2);
    return c;
  };
  const Path path = {q(0, 0, 0), q(1, 1, 0),   q(2, 0, 0),  q(3, 0, 1),
                     q(4, 0, 1), q(5, 1, 1.0), q(6, 0, 1.0)};
  const ShortCurve curve = shortenedCurve(space, curveOfPath(space, path).pieces, kAllFree);
  ASSERT_EQ(curve.pieces.size(), 3u);
  EXPECT_EQ(Configuration(curve.pieces[1].coefficients.col(0)), q(2, 0, 0));
  EXPECT_EQ(Configuration(curve.pieces[1].coefficients.rightCols<1>()), q(3, 0, 1));
  EXPECT_EQ(Configuration(curve.pieces[2].coefficients.col(0)), q(3, 0, 1));
  EXPECT_EQ(Configuration(curve.pieces[2].coefficients.col(3)).tail<4>(), q(3, 0, 1).tail<4>());
}

}  // namespace
}  // namespace corridor
