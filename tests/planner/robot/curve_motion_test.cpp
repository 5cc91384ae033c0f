// Tests of the relative motions of frames along pieces of curves, against independent kinematics in
// long double.
#include <algorithm>
#include <cmath>
#include <iostream>

#include <gtest/gtest.h>

#include "planner/robot/edge_motion.h"
#include "planner/trajectory/curve_pieces.h"
#include "tests/planner/robot/random_trees.h"
#include "tests/planner/robot/reference_kinematics.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::LongReal;
using test::MovingPose;
using test::RandomTrees;
using test::ReferenceKinematics;

/// Returns a random piece. Some joints rest, some reverse their direction at the middle, some move
/// linearly, and some have large coefficients that cancel.
CurvePiece randomPiece(RandomTrees& random, int degree, double size) {
  random.makeEdge(size);
  CurvePiece piece;
  const auto numbers = static_cast<Eigen::Index>(random.space.size());
  piece.coefficients.resize(numbers, degree + 1);
  piece.error = Configuration::Zero(numbers);
  piece.coefficients.col(0) = random.from;
  piece.coefficients.col(degree) = random.to;
  for (Eigen::Index row = 0; row < numbers; ++row) {
    const auto kind = random.randomIndex(8);
    const double from = random.from[row], to = random.to[row];
    for (int i = 0; i <= degree; ++i) {
      double& d = piece.coefficients(row, i);
      if (kind == 0) d = from;
      if (kind == 1) d = from + std::abs(i - 0.5 * degree) * size;  // rate 0 at the middle
      if (kind == 2) d = from + (to - from) * i / degree;
      if (kind == 3) d = 1e3 * (i % 2 ? 1 : -1);
      if (kind > 3 && i > 0 && i < degree) d = from + size * random.real();
    }
  }
  for (const Coordinate& c : random.space.coordinates()) {
    if (c.kind != Coordinate::Kind::rotation) continue;
    const auto first = static_cast<Eigen::Index>(c.first);
    piece.coefficients.col(0).segment<4>(first) = random.from.segment<4>(first);
    piece.coefficients.col(degree).segment<4>(first) = random.to.segment<4>(first);
  }
  return piece;
}

std::pair<double, double> dyadicInterval(RandomTrees& random) {
  const double h = std::ldexp(0.5, -static_cast<int>(random.randomIndex(12)));
  return {h + 2 * h * std::floor(random.real(0, 0.5 / h)), h};
}

/// Returns the rounding error of the reference: some 100 roundings, each of 2^-64 relative to
/// values of up to 10^3 rad or m, times the lengths.
double noise(const CurvePiece& piece, double reach) {
  const double largest =
      piece.coefficients.size() == 0 ? 0 : piece.coefficients.cwiseAbs().maxCoeff();
  return 1e-17 * (1 + largest) * (10 + reach) * (1 + piece.degree());
}

TEST(CurveMotion, PosesAndTwistsAreWithinTheirStatedError) {
  RandomTrees random(test::testSeed(41));
  const int count = test::casesOf(20'000, 500'000);
  double worst = 0;
  for (int n = 0; n < count; ++n) {
    if (n % 5 == 0) random.makeTree(1 + random.randomIndex(8));
    const CurvePiece piece = randomPiece(random, 1 + n % 9, n % 3 ? 1 : 5);
    const Scene::FramePair pair[] = {random.pair()};
    EdgeMotion motion(random.tree, random.space, pair, random.noTube());
    motion.set(piece);
    const ReferenceKinematics reference(random.tree, random.space, piece);
    const auto [t, h] = dyadicInterval(random);
    const MovingPose real = reference.relative(pair[0].a, pair[0].b, t);
    for (const double half : {0.0, h}) {
      const RelativeMotion w = motion.relativeMotion(0, t, half);
      const Vec3 p = random.vector(n % 2 ? 3 : 0.01);
      const double bound = w.fixedError + w.reachError * (w.X_AB.m * p).norm() +
                           noise(piece, p.norm() + static_cast<double>(real.t.norm()));
      const auto off = static_cast<double>((test::exactly(w.X_AB, p) - real.at(p)).norm());
      ASSERT_LE(off, bound) << "case " << n << ", t = " << t;
      const test::Vec3L step =
          w.linear.cast<LongReal>() +
          w.angular.cast<LongReal>().cross(w.X_AB.m.cast<LongReal>() * p.cast<LongReal>());
      const auto offTwist = static_cast<double>((step - half * real.velocity(p)).norm());
      ASSERT_LE(offTwist, bound) << "case " << n << ", t = " << t << ", h = " << half;
      worst = std::max({worst, off / bound, offTwist / bound});
    }
  }
  std::cout << "largest share of the stated error: " << worst << "\n";
  EXPECT_GT(worst, 1e-2);
}

/// In the whole interval, no point of b moves farther than the motion bound.
TEST(CurveMotion, MotionBoundsHold) {
  RandomTrees random(test::testSeed(42));
  const int count = test::casesOf(4'000, 300'000);
  double worstIsotropic = 0, worstBeyond = 0;
  for (int n = 0; n < count; ++n) {
    if (n % 5 == 0) random.makeTree(1 + random.randomIndex(6));
    const CurvePiece piece = randomPiece(random, 1 + n % 9, n % 3 ? 1 : 0.1);
    const Scene::FramePair pair[] = {random.pair()};
    EdgeMotion motion(random.tree, random.space, pair, random.noTube());
    motion.set(piece);
    const ReferenceKinematics reference(random.tree, random.space, piece);
    const auto [t, h] = dyadicInterval(random);
    const RelativeMotion w = motion.relativeMotion(0, t, h);
    const Vec3 p = random.vector();
    const Vec3 y = w.X_AB.m * p;
    const MotionBound bound = motionBound(w, y + w.X_AB.t, 0);
    const test::Vec3L x = test::exactly(w.X_AB, p);
    const test::Vec3L first = (w.linear + w.angular.cross(y)).cast<LongReal>();
    for (int k = -4; k <= 4; ++k) {
      const LongReal s = k / 4.0L;
      const test::Vec3L at = reference.relative(pair[0].a, pair[0].b, t + s * h).at(p);
      const double blur = noise(piece, p.norm() + static_cast<double>(at.norm()));
      const auto moved = static_cast<double>((at - x).norm());
      ASSERT_LE(moved, bound.isotropic + bound.pad + blur) << "case " << n << ", s = " << k;
      const Vec3 m = random.direction();
      const test::Vec3L n_A = m.cast<LongReal>();
      const auto beyond = static_cast<double>(std::abs(n_A.dot(at - x - s * first)));
      const double allowed =
          bound.secondOrderAcross * m.cross(w.angular).norm() + bound.secondOrder + bound.pad;
      ASSERT_LE(beyond, allowed * (1 + 1e-15) + blur) << "case " << n << ", s = " << k;
      if (bound.isotropic > 1e-6) {
        worstIsotropic = std::max(worstIsotropic, moved / (bound.isotropic + bound.pad));
        worstBeyond = std::max(worstBeyond, beyond / allowed);
      }
    }
  }
  std::cout << "largest share of the isotropic bound " << worstIsotropic << ", of the second order "
            << worstBeyond << "\n";
  EXPECT_GT(worstIsotropic, 0.9);
  EXPECT_GT(worstBeyond, 0.9);
}

/// The `error` of a piece widens the tube of each joint that depends on the coordinate with this
/// error, by the error times the joint's multiplier.
TEST(CurveMotion, TheErrorOfAPieceIsPartOfTheTube) {
  KinematicTree tree;
  ConfigurationSpace space;
  space.add({});
  Frame frame;
  frame.joint = Frame::Joint::revolute;
  frame.variable = 0;
  frame.multiplier = -2;
  const Scene::FramePair pair[] = {{0, tree.add(frame)}};
  EdgeMotion motion(tree, space, pair, Configuration::Constant(1, 0.25));
  CurvePiece piece{Eigen::MatrixXd::Constant(1, 4, 0.5), Configuration::Constant(1, 0.125)};
  motion.set(piece);
  EXPECT_TRUE(motion.still());
  RelativeMotion w = motion.relativeMotion(0, 0.5, 0.5);
  ASSERT_EQ(w.screws.size(), 1u);
  EXPECT_EQ(w.screws[0].amount, 0);
  EXPECT_EQ(w.screws[0].deviation, 0);
  EXPECT_NEAR(w.screws[0].tube, 0.75, 1e-12);
  // If an edge is set afterwards, the error of the piece no longer counts.
  motion.set(Configuration::Zero(1), Configuration::Zero(1));
  EXPECT_NEAR(motion.relativeMotion(0, 0.5, 0.5).screws[0].tube, 0.5, 1e-12);
}

/// A joint that reverses its direction at the middle has the rate 0 there, and yet it moves.
TEST(CurveMotion, AJointThatTurnsRoundIsNotAtRest) {
  KinematicTree tree;
  ConfigurationSpace space;
  space.add({});
  Frame frame;
  frame.joint = Frame::Joint::prismatic;
  frame.variable = 0;
  const Scene::FramePair pair[] = {{0, tree.add(frame)}};
  EdgeMotion motion(tree, space, pair, Configuration::Zero(1));
  motion.set(CurvePiece{(Eigen::MatrixXd(1, 3) << 1, -1, 1).finished(), Configuration::Zero(1)});
  EXPECT_FALSE(motion.still());
  const RelativeMotion w = motion.relativeMotion(0, 0.5, 0.25);  // (2t − 1)² is 1/4 at the ends
  ASSERT_EQ(w.screws.size(), 1u);
  EXPECT_NEAR(w.screws[0].deviation, 0.25, 1e-12);
  EXPECT_GE(w.screws[0].deviation, 0.25);
  EXPECT_GE(motionBound(w, Vec3::Zero(), 0).isotropic, 0.25);
}

/// A straight piece has the same poses and twists as the edge, and no deviation from them.
TEST(CurveMotion, StraightPiecesAreEdges) {
  RandomTrees random(test::testSeed(43));
  for (int n = 0; n < 5'000; ++n) {
    random.makeTree(1 + random.randomIndex(6));
    random.makeEdge(2);
    if (random.space.ambiguous(random.from, random.to)) continue;
    const Scene::FramePair pair[] = {random.pair()};
    EdgeMotion edge(random.tree, random.space, pair, random.noTube());
    EdgeMotion curve(random.tree, random.space, pair, random.noTube());
    edge.set(random.from, random.to);
    if (edge.ambiguous()) continue;
    const CurvePiece piece = curveOfPath(random.space, {random.from, random.to}).pieces[0];
    curve.set(piece);
    const auto [t, h] = dyadicInterval(random);
    const RelativeMotion v = edge.relativeMotion(0, t, h), w = curve.relativeMotion(0, t, h);
    const double most = 1e-12 * (1 + v.X_AB.t.norm());
    ASSERT_LE((v.X_AB.m - w.X_AB.m).norm(), 1e-13) << n;
    ASSERT_LE((v.X_AB.t - w.X_AB.t).norm(), most) << n;
    ASSERT_LE((v.linear - w.linear).norm() + (v.angular - w.angular).norm(), most) << n;
    for (const ScrewMotion& screw : w.screws) ASSERT_EQ(screw.deviation, 0) << n;
    const Configuration q = configurationAt(random.space, piece, t);
    ASSERT_LT(random.space.distance(q, random.space.interpolate(random.from, random.to, t)), 1e-13);
  }
}

}  // namespace
}  // namespace corridor
