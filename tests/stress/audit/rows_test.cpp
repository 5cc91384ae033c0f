// The curves of trajectory files, against their meaning (planner/trajectory/README.md), which is
// evaluated in 128 bits: Hermite polynomials of the numbers in the file. Texts are read, converted
// to pieces, and decided by the checker and the verifier.
#include "tests/stress/audit/rows.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <optional>

#include <gtest/gtest.h>

#include "planner/checker/checker.h"
#include "planner/model/model_builder.h"
#include "planner/trajectory/trajectory_curve.h"
#include "tests/stress/audit/audit.h"
#include "tests/support/support.h"

namespace corridor::audit {
namespace {

constexpr double kRadius = 0.125;

/// A carriage with a sphere that slides along x, a continuous joint, and a revolute joint. If
/// `wall` is given, a triangle stands in the plane x = wall.
Model gantry(std::optional<double> wall = {}) {
  RobotParts parts;
  parts.links = {{"base", {}},
                 {"carriage", {shapeOf("ball", Sphere{kRadius})}},
                 {"turned", {}},
                 {"lifted", {}}};
  RobotParts::Joint slide, pan, lift;
  slide.name = "slide", slide.type = JointType::prismatic;
  slide.parent = "base", slide.child = "carriage";
  slide.lower = -1e15, slide.upper = 1e15;
  pan.name = "pan", pan.type = JointType::continuous;
  pan.parent = "base", pan.child = "turned";
  lift.name = "lift", lift.type = JointType::revolute;
  lift.parent = "turned", lift.child = "lifted";
  lift.lower = -1e15, lift.upper = 1e15;
  parts.joints = {slide, pan, lift};
  ModelBuilder builder;
  builder.addRobot(parts);
  if (wall) {
    TriangleMesh mesh;
    mesh.vertices = {Vec3(*wall, -9, -9), Vec3(*wall, 9, -9), Vec3(*wall, 0, 9)};
    mesh.triangles = {{0, 1, 2}};
    builder.addObstacle("wall", {shapeOf("wall", mesh)});
  }
  return builder.build();
}

Polynomial<Quad> polynomialOf(const CurvePiece& piece, std::size_t joint) {
  Polynomial<Quad> polynomial;
  polynomial.degree = piece.degree();
  for (int i = 0; i <= polynomial.degree; ++i)
    polynomial.d[static_cast<std::size_t>(i)] =
        piece.coefficients(static_cast<Eigen::Index>(joint), i);
  return polynomial;
}

std::string caseName(std::uint64_t seed, long number) {
  return "CORRIDOR_SEED=" + std::to_string(seed) + " CORRIDOR_AUDIT_CASE=" + std::to_string(number);
}

corridor::Curve curveOfText(const std::string& text, const Model& model, int degree) {
  TrajectoryRows rows = readTrajectory("rows.csv", text, model);
  const RowInterpolation between = interpolationOf(rows, {});
  const RowInterpolation expected = degree == 1   ? RowInterpolation::linear
                                    : degree == 3 ? RowInterpolation::cubic
                                                  : RowInterpolation::quintic;
  EXPECT_EQ(between, expected);
  return curveOf(rows, model.space, between);
}

TEST(RowCurves, AreWithinTheErrorOfTheirPieces) {
  const std::uint64_t seed = test::testSeed(16);
  const char* only = std::getenv("CORRIDOR_AUDIT_CASE");
  const long first = only ? std::stol(only) : 0, count = only ? 1 : countOf(700, 100'000);
  const Model model = gantry();
  ASSERT_EQ(model.space.numberNames(), (std::vector<std::string>{"slide", "pan", "lift"}));
  Quad conversion = 0, controller = 0;  // the largest deviations, as shares of the error
  for (long number = first; number < first + count; ++number) {
    Dice dice = diceOf(seed, number);
    const RowKind kind = kRowKinds[static_cast<std::size_t>(number) % std::size(kRowKinds)];
    const int degree = 1 + 2 * static_cast<int>(dice.index(3));
    const bool timed = degree > 1 || dice.oneIn(2);
    const std::vector<FileRow> rows = randomRows(dice, kind, 2 + dice.index(4));
    const corridor::Curve curve = curveOfText(textOf(rows, degree, timed), model, degree);
    ASSERT_EQ(curve.pieces.size() + 1, rows.size());
    for (std::size_t k = 0; k < curve.pieces.size(); ++k) {
      const CurvePiece& piece = curve.pieces[k];
      FileRow from = rows[k], to = rows[k + 1];
      if (!timed) from.time = 0, to.time = 1;
      for (std::size_t j = 0; j < kRowJoints; ++j) {
        const Polynomial<Quad> polynomial = polynomialOf(piece, j);
        const Quad error = piece.error[static_cast<Eigen::Index>(j)];
        const auto expectNear = [&](Quad value, Quad tau, Quad& most) {
          const Quad off = magnitude(value - polynomial.at(tau));
          most = std::max(most, off / error);
          ASSERT_LE(static_cast<double>(off / error), 1)
              << caseName(seed, number) << ", row " << k << ", joint " << j << ", degree " << degree
              << ", at " << static_cast<double>(tau);
        };
        // Evenly, and close to the ends.
        for (int i = 0; i <= 24; ++i)
          expectNear(trueValue(from, to, degree, j, Quad(i) / 24), Quad(i) / 24, conversion);
        for (int i = 6; i <= 60; i += 6)
          for (const bool end : {false, true}) {
            const Quad tau = end ? 1 - ldexpq(1, -i) : ldexpq(1, -i);
            expectNear(trueValue(from, to, degree, j, tau), tau, conversion);
          }
        for (int i = 0; i < 6; ++i) {
          const double T = controllerTime(dice, to.time) - controllerTime(dice, from.time);
          if (!(std::abs(T - (to.time - from.time)) < 0.5 * T)) continue;
          const double t = dice.real(0, 1) * T;
          expectNear(controllerValue(from, to, degree, j, T, t), Quad(t) / Quad(T), controller);
        }
        if (testing::Test::HasFatalFailure()) return;
        EXPECT_EQ(piece.coefficients(static_cast<Eigen::Index>(j), 0), from.p[j]);
        EXPECT_EQ(piece.coefficients(static_cast<Eigen::Index>(j), piece.degree()), to.p[j]);
      }
    }
  }
  std::cout << "largest deviation, as a share of the error: conversion "
            << static_cast<double>(conversion) << ", controller " << static_cast<double>(controller)
            << "\n";
  if (only) return;
  EXPECT_GT(conversion, 0x1p-12L);
  EXPECT_GT(controller, 0x1p-9L);
}

/// A point of the curve of a file: the largest value of joint 0, and the index of its piece.
struct Top {
  Quad value = -std::numeric_limits<double>::infinity();
  std::size_t piece = 0;
};

Top topOf(const std::vector<FileRow>& rows, int degree) {
  Top top;
  const int samples = 64;
  for (std::size_t k = 0; k + 1 < rows.size(); ++k) {
    const auto at = [&](Quad tau) { return trueValue(rows[k], rows[k + 1], degree, 0, tau); };
    int best = 0;
    for (int i = 1; i <= samples; ++i)
      if (at(Quad(i) / samples) > at(Quad(best) / samples)) best = i;
    Quad low = Quad(std::max(0, best - 1)) / samples,
         high = Quad(std::min(samples, best + 1)) / samples;
    Quad value = at(Quad(best) / samples);
    for (int i = 0; i < 80; ++i) {  // thirds: the curve has one top in the bracket
      const Quad a = low + (high - low) / 3, b = high - (high - low) / 3, fa = at(a), fb = at(b);
      value = std::max(value, std::max(fa, fb));
      (fa < fb ? low : high) = fa < fb ? a : b;
    }
    if (value > top.value) top = {value, k};
  }
  return top;
}

/// A sphere on the carriage just touches the wall where the curve of the file is highest, or stays
/// away from it by less than the tube and the error of the piece; or by more, as a control.
TEST(RowCurves, AreNotProvedIfTheyTouch) {
  const std::uint64_t seed = test::testSeed(17);
  const char* only = std::getenv("CORRIDOR_AUDIT_CASE");
  const long first = only ? std::stol(only) : 0, count = only ? 1 : countOf(300, 40'000);
  long touching = 0, within = 0, apart = 0, unproved = 0;
  for (long number = first; number < first + count; ++number) {
    Dice dice = diceOf(seed, number);
    const RowKind kinds[] = {RowKind::usual, RowKind::tinyDurations, RowKind::longDurations,
                             RowKind::largeTimes};
    const RowKind kind = kinds[number % 4];
    const int degree = 3 + 2 * static_cast<int>(dice.index(2));
    const std::vector<FileRow> rows = randomRows(dice, kind, 2 + dice.index(3));
    const std::string text = textOf(rows, degree, true);
    const Top top = topOf(rows, degree);
    const double error = curveOfText(text, gantry(), degree).pieces[top.piece].error[0];
    const double tube = dice.oneIn(2) ? 0 : dice.power(-9, -3), stray = tube + error;
    const double tolerance = 1e-9;
    if (magnitude(top.value) > 100 || stray > 0.1) continue;
    const std::size_t which = dice.index(3);
    const double gap = which == 0   ? -dice.power(-14, -2)
                       : which == 1 ? stray * dice.real(0, 0.999)
                                    : stray * 1.01 + dice.power(std::log10(4 * tolerance), -1);
    const double wall = static_cast<double>(top.value + Quad(kRadius) + Quad(gap));
    const Quad real = Quad(wall) - Quad(kRadius) - top.value;

    const Model model = gantry(wall);
    const corridor::Curve curve = curveOfText(text, model, degree);
    CheckerOptions options;
    options.tube = Configuration::Constant(3, tube);
    options.tolerance = tolerance;
    const Checker checker(model, options);
    bool free = true;
    for (const CurvePiece& piece : curve.pieces)
      free = free && checker.certifyCurve(piece, dice.oneIn(2)).verdict == MotionVerdict::free;
    PathProblem problem;
    problem.tree = &model.tree;
    problem.space = &model.space;
    for (const ModelBody& body : model.bodies)
      problem.bodies.push_back({body.name,
                                body.shapes[0].mesh ? &body.shapes[0].mesh->mesh : nullptr,
                                body.shapes[0].parts, false, body.frame});
    ASSERT_EQ(problem.bodies.size(), 2U);
    problem.pairs = {{0, 1}};
    problem.tube = options.tube;
    problem.tolerance = tolerance;
    const bool proved = verifyCurve(problem, curve.pieces).verdict == PathVerdict::proved;
    const std::string name = caseName(seed, number);
    if (real <= Quad(tube) + Quad(error)) {
      ++(real <= 0 ? touching : within);
      EXPECT_FALSE(free) << "FALSE FREE: " << name;
      EXPECT_FALSE(proved) << "FALSE PROVED: " << name;
    } else if (real > Quad(stray) + 3 * Quad(tolerance)) {
      ++apart;
      unproved += !free || !proved;
    }
  }
  std::cout << touching << " files touch, " << within << " touch within tube and error, " << apart
            << " do not, of which " << unproved << " are not proved\n";
  if (only) return;
  EXPECT_GT(touching, count / 6);
  EXPECT_GT(within, count / 8);
  EXPECT_GT(apart, count / 6);
  EXPECT_LE(unproved, apart / 20);
}

}  // namespace
}  // namespace corridor::audit
