// Tests of smoothing in the plane, where the curves have closed forms.
#include "planner/solve/smooth_path.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "tests/planner/solve/plane_curves.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

/// Expects that successive pieces join with the same position and direction, and that the second
/// derivatives are 0 on both sides of each joint.
void expectSmooth(const std::vector<CurvePiece>& pieces) {
  for (std::size_t k = 0; k + 1 < pieces.size(); ++k) {
    const CurvePiece &a = pieces[k], &b = pieces[k + 1];
    ASSERT_EQ(Configuration(a.coefficients.rightCols<1>()), Configuration(b.coefficients.col(0)));
    const Configuration u = derivative(a, 1, 1), v = derivative(b, 1, 0);
    EXPECT_NEAR(u.normalized().dot(v.normalized()), 1, 1e-12) << k;
    EXPECT_LT(derivative(a, 2, 1).norm(), 1e-9) << k;
    EXPECT_LT(derivative(b, 2, 0).norm(), 1e-9) << k;
  }
}

TEST(SmoothPath, RoundsTheCornersOfAFreePath) {
  const ConfigurationSpace space = lines(2);
  const Path path = {place(0, 0), place(1, 0), place(1, 1), place(3, 2)};
  const SmoothPath smooth = smoothedPath(space, path, kAllFree);
  EXPECT_EQ(smooth.corners, 2u);
  EXPECT_EQ(smooth.rounded, 2u);
  EXPECT_EQ(Configuration(smooth.pieces.front().coefficients.col(0)), path.front());
  EXPECT_EQ(Configuration(smooth.pieces.back().coefficients.rightCols<1>()), path.back());
  expectSmooth(smooth.pieces);
}

TEST(SmoothPath, KeepsTheDeviation) {
  const ConfigurationSpace space = lines(2);
  const Path path = {place(0, 0), place(1, 0), place(1, 1), place(3, 1)};
  for (const double most : {1e-3, 1e-2, 0.05}) {
    SmoothOptions options;
    options.deviation = most;
    const SmoothPath smooth = smoothedPath(space, path, kAllFree, options);
    EXPECT_EQ(smooth.rounded, 2u);
    expectSmooth(smooth.pieces);
    double farthest = 0;
    for (const CurvePiece& piece : smooth.pieces)
      for (int i = 0; i <= 100; ++i) {
        const Configuration q = configurationAt(space, piece, i / 100.0);
        double nearest = HUGE_VAL;  // the distance from the path, in the maximum norm
        for (std::size_t k = 0; k + 1 < path.size(); ++k)
          for (int j = 0; j <= 2000; ++j)
            nearest = std::min(
                nearest,
                (path[k] + j / 2000.0 * (path[k + 1] - path[k]) - q).cwiseAbs().maxCoeff());
        farthest = std::max(farthest, nearest);
      }
    EXPECT_LE(farthest, most + 5e-4);  // samples of the path are up to 1e-3 apart
    EXPECT_GT(farthest, 0.3 * most);
  }
}

/// Curves of adjacent corners that meet on an edge have no line of an ulp between them.
TEST(SmoothPath, HasNoLinesOfAnUlp) {
  const ConfigurationSpace space = lines(2);
  std::mt19937_64 random(test::testSeed(62));
  const auto real = [&] { return std::uniform_real_distribution(-1.0, 1.0)(random); };
  int meetings = 0;
  for (int n = 0; n < 200; ++n) {
    Path path = {place(0, 0)};
    for (int k = 0; k < 6; ++k) path.push_back(path.back() + place(1 + 0.5 * real(), 2 * real()));
    // Curves over more than one corner are refused, so that all edges stay.
    const CurveTest isCorner = [&](const CurvePiece& piece, double) {
      return piece.coefficients.col(2) == piece.coefficients.col(3) ||
             (piece.coefficients.col(2) - piece.coefficients.col(3)).norm() < 1e-12;
    };
    const SmoothPath smooth = smoothedPath(space, path, isCorner);
    for (std::size_t k = 0; k < smooth.pieces.size(); ++k) {
      const auto& c = smooth.pieces[k].coefficients;
      ASSERT_GT((c.rightCols<1>() - c.col(0)).norm(), 1e-9) << n << ", piece " << k;
      meetings += k > 0 && smooth.pieces[k].degree() == 5 && smooth.pieces[k - 1].degree() == 5;
    }
    expectSmooth(smooth.pieces);
  }
  EXPECT_GT(meetings, 100);
}

/// A disc is inside each corner of the path. Curves that cut a corner so far that they touch its
/// disc are refused.
TEST(SmoothPath, UsesOnlyCurvesThatAreProved) {
  const ConfigurationSpace space = lines(2);
  std::mt19937_64 random(test::testSeed(61));
  const auto real = [&] { return std::uniform_real_distribution(-1.0, 1.0)(random); };
  std::size_t rounded = 0, corners = 0;
  for (int n = 0; n < 300; ++n) {
    Path path = {place(0, 0)};
    for (int k = 0; k < 6; ++k) path.push_back(path.back() + place(1 + 0.5 * real(), 2 * real()));
    const double radius = 0.02 + 0.1 * std::abs(real());
    std::vector<Configuration> centres;  // discs inside the corners, which the path just passes
    for (std::size_t k = 1; k + 1 < path.size(); ++k) {
      const Configuration u = (path[k] - path[k - 1]).normalized(),
                          v = (path[k + 1] - path[k]).normalized();
      const Configuration inside = (v - u).normalized();
      const double half = std::acos(std::clamp(-u.dot(v), -1.0, 1.0)) / 2;
      centres.push_back(path[k] + (radius * 1.2 / std::sin(half)) * inside);
    }
    const auto isFreeAt = [&](const Configuration& q) {
      return std::all_of(centres.begin(), centres.end(),
                         [&](const Configuration& c) { return (q - c).norm() > radius; });
    };
    const CurveTest isFree = [&](const CurvePiece& piece, double) {
      for (int i = 0; i <= 300; ++i)
        if (!isFreeAt(configurationAt(space, piece, i / 300.0))) return false;
      return true;
    };
    const SmoothPath smooth = smoothedPath(space, path, isFree);
    rounded += smooth.rounded, corners += smooth.corners;
    std::size_t curves = 0;
    for (const CurvePiece& piece : smooth.pieces) {
      if (piece.degree() == 1) continue;
      ++curves;
      ASSERT_TRUE(isFree(piece, 0)) << n;
    }
    ASSERT_LE(curves, smooth.rounded);
    // If no curve passes the test, the path does not change.
    const SmoothPath polyline =
        smoothedPath(space, path, [](const CurvePiece&, double) { return false; });
    ASSERT_EQ(polyline.rounded, 0u);
    ASSERT_EQ(polyline.pieces.size(), path.size() - 1);
  }
  EXPECT_GT(rounded, corners * 9 / 10);
}

TEST(SmoothPath, StaysWithinTheBounds) {
  const ConfigurationSpace space = lines(2, 1);
  const Path path = {place(-1, -1), place(1, -1), place(1, 1), place(-1, 1), place(-1, -0.5)};
  const SmoothPath smooth = smoothedPath(space, path, kAllFree);
  for (const CurvePiece& piece : smooth.pieces) {
    EXPECT_LE(piece.coefficients.maxCoeff(), 1);
    EXPECT_GE(piece.coefficients.minCoeff(), -1);
  }
  EXPECT_EQ(smooth.rounded, 3u);
}

TEST(SmoothPath, CirclesContinueBeyondPi) {
  ConfigurationSpace space;
  Coordinate yaw;
  yaw.kind = Coordinate::Kind::circle;
  yaw.name = "yaw";
  space.addGroup({CoordinateGroup::Kind::joints, "", {space.add(yaw)}});
  const auto q = [](double x) { return Configuration::Constant(1, x); };
  const SmoothPath smooth = smoothedPath(space, {q(2), q(3), q(-2.5), q(-1)}, kAllFree);
  const double end = smooth.pieces.back().coefficients(0, smooth.pieces.back().degree());
  EXPECT_NEAR(end, 2 * M_PI - 1, 1e-14);
  for (const CurvePiece& piece : smooth.pieces)
    EXPECT_GE(piece.coefficients(0, piece.degree()), piece.coefficients(0, 0));
}

/// A robot rests where a rotation changes its axis, so such corners stay.
TEST(SmoothPath, CornersOfRotationsStay) {
  ConfigurationSpace space = lines(1);
  Coordinate rotation;
  rotation.kind = Coordinate::Kind::rotation;
  rotation.name = "rotation";
  space.addGroup({CoordinateGroup::Kind::joints, "", {space.add(rotation)}});
  const auto q = [](double x, double angle) {
    Configuration state(5);
    state << x, 0, 0, std::sin(angle / 2), std::cos(angle / 2);
    return state;
  };
  const SmoothPath smooth =
      smoothedPath(space, {q(0, 0), q(1, 0.5), q(2, 0), q(3, 0), q(2.5, 0), q(3, 0)}, kAllFree);
  EXPECT_EQ(smooth.corners, 4u);
  EXPECT_EQ(smooth.rounded, 2u);
}

TEST(SmoothPath, PathsWithoutCorners) {
  const ConfigurationSpace space = lines(2);
  EXPECT_EQ(smoothedPath(space, {place(1, 2)}, kAllFree).pieces.size(), 1u);
  EXPECT_EQ(smoothedPath(space, {place(1, 2), place(1, 2)}, kAllFree).pieces.size(), 1u);
  const SmoothPath edge = smoothedPath(space, {place(1, 2), place(1, 2), place(3, 2)}, kAllFree);
  ASSERT_EQ(edge.pieces.size(), 1u);
  EXPECT_EQ(edge.corners, 0u);
  EXPECT_EQ(edge.tests, 0u);
}

}  // namespace
}  // namespace corridor
