// Tests of pieces of curves that graze an obstacle by construction, and of random pieces against
// samples.
#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>

#include <gtest/gtest.h>

#include "collision/queries/interference.h"
#include "planner/robot/edge_motion.h"
#include "planner/trajectory/curve_pieces.h"
#include "tests/planner/robot/random_trees.h"
#include "tests/planner/robot/reference_kinematics.h"
#include "tests/support/meshes.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::add;
using test::LongReal;
using test::MovingPose;
using test::RandomTrees;
using test::ReferenceKinematics;

/// Returns a random piece for the tree. The rows are so smooth that some pieces pass each place
/// only once.
CurvePiece smoothPiece(RandomTrees& random, int degree, double size) {
  random.makeEdge(size);
  CurvePiece piece;
  const auto numbers = static_cast<Eigen::Index>(random.space.size());
  piece.coefficients.resize(numbers, degree + 1);
  piece.error = Configuration::Zero(numbers);
  for (Eigen::Index row = 0; row < numbers; ++row)
    for (int i = 0; i <= degree; ++i)
      piece.coefficients(row, i) = random.from[row] + size * random.real();
  for (const Coordinate& c : random.space.coordinates()) {
    if (c.kind != Coordinate::Kind::rotation) continue;
    const auto first = static_cast<Eigen::Index>(c.first);
    piece.coefficients.col(0).segment<4>(first) = random.from.segment<4>(first);
    piece.coefficients.col(degree).segment<4>(first) = random.to.segment<4>(first);
  }
  return piece;
}

/// A piece on which a corner of b passes over a face of a, or a corner of a under a face of b. At
/// the time t*, corner and face are `gap` apart along the face's normal, which is orthogonal to the
/// velocity at t*. At all other times b is higher. So the verdict is known without an oracle.
struct CurveGrazing {
  CurvePiece piece;
  Scene::FramePair frames{0, 0};
  TriangleMesh a, b;
  bool known = false;

  CurveGrazing(RandomTrees& random, int n, double gap) {
    random.makeTree(1 + random.randomIndex(5));
    piece = smoothPiece(random, 2 + n % 8, n % 3 ? 0.5 : 2);
    frames.b = random.tree.frames.size() - 1;
    const ReferenceKinematics reference(random.tree, random.space, piece);
    const double at = n % 5 ? random.real(0.05, 0.95) : n % 2;
    const MovingPose there = reference.relative(0, frames.b, at);
    const Vec3 p = random.vector(0.5);
    const test::Vec3L x = there.at(p), v = there.velocity(p);
    if (v.norm() < 1e-6L) return;
    const test::Vec3L away = random.direction().cast<LongReal>();
    test::Vec3L up =
        n % 5 ? test::Vec3L(away - v * (v.dot(away) / v.squaredNorm()))
              : test::Vec3L(n % 2 ? -v : v);  // approaches at the end, leaves at the start
    up.normalize();
    const test::Vec3L later =
        reference.relative(0, frames.b, at + (at < 0.5 ? 0.01L : -0.01L)).at(p);
    if (n % 5 && up.dot(later - x) < 0) up = -up;
    const test::Vec3L side = up.unitOrthogonal(), other = up.cross(side);
    const auto around = [&](int i, double r) {
      return test::Vec3L(r * (std::cos(2.1L * i) * side + std::sin(2.1L * i) * other));
    };
    test::Vec3L low[3], high[3];
    for (int i = 0; i < 3; ++i) low[i] = around(i, random.real(0.3, 1));
    high[0] = test::Vec3L::Zero();
    high[1] = around(0, 0.2) + 0.3L * up, high[2] = around(1, 0.3) + 0.2L * up;
    if (n % 2) {  // a's corner under b's face
      for (int i = 0; i < 3; ++i) high[i] = around(i, random.real(0.1, 0.4));
      low[0] = test::Vec3L::Zero(), low[1] = around(0, 0.2) - 0.3L * up,
      low[2] = around(1, 0.3) - 0.2L * up;
    }
    const auto world = [&](const test::Vec3L& y) { return Vec3((x + y).cast<double>()); };
    const auto body = [&](const test::Vec3L& y) {
      return Vec3((there.m.transpose() * (x + y + gap * up - there.t)).cast<double>());
    };
    add(a, world(low[0]), world(low[1]), world(low[2]));
    add(b, body(high[0]), body(high[1]), body(high[2]));
    const auto lowest = [&](LongReal t) {
      const MovingPose X = reference.relative(0, frames.b, t);
      LongReal least = 1e300L;
      for (const Vec3& q : b.vertices) least = std::min(least, up.dot(X.at(q) - x));
      return least;
    };
    const LongReal least = lowest(at);
    known = true;
    const auto check = [&](LongReal t) {
      if (t >= 0 && t <= 1) known = known && lowest(t) >= least - 1e-16L;
    };
    for (int i = 0; i <= 200 && known; ++i) check(i / 200.0L);
    for (int k = 2; k < 9 && known; ++k)
      check(at + std::pow(10.0L, -k)), check(at - std::pow(10.0L, -k));
  }
};

TEST(CurveMotion, CurvesThatGrazeByConstruction) {
  RandomTrees random(test::testSeed(51));
  const int count = test::casesOf(55, 20'000);
  int apart = 0, together = 0, notFree = 0, notFound = 0;
  QueryContext context;
  for (int n = 0; apart + together < count; ++n) {
    const double amount = std::pow(10.0, -2 - n % 11);
    const double gap = n / 11 % 2 ? amount : -amount;
    const CurveGrazing g(random, n, gap);
    if (!g.known) continue;
    (gap > 0 ? apart : together)++;
    EdgeMotion motion(random.tree, random.space, {&g.frames, 1}, random.noTube());
    motion.set(g.piece);
    MotionOptions options;
    options.tolerance = 1e-7;
    options.earliest = n % 2;
    const Body a("", g.a), b("", g.b);
    const MotionPair pair{&a, &b};
    const MotionResult r = certifyMotion(motion, {&pair, 1}, options, context);
    if (gap < 0) {
      ASSERT_NE(r.verdict, MotionVerdict::free) << n << ", depth " << amount;
      notFound += r.verdict != MotionVerdict::contact && amount > 1e-6;
    } else {
      ASSERT_NE(r.verdict, MotionVerdict::contact) << n << ", gap " << amount;
      notFree += r.verdict != MotionVerdict::free && amount > 2e-7;
    }
  }
  EXPECT_EQ(notFree, 0);
  EXPECT_EQ(notFound, 0);
  EXPECT_GT(apart, count / 4);
  EXPECT_GT(together, count / 4);
  std::cout << apart << " apart, " << together << " together; "
            << context.counters.boxTests / (apart + together) << " box tests per piece\n";
}

/// Returns the halves of a piece, by de Casteljau's algorithm. Each of up to 9 levels rounds once,
/// by 2^-53 of the largest coefficient. The middle of a slerp is rounded by some 2^-52.
std::array<CurvePiece, 2> halvesOf(const ConfigurationSpace& space, const CurvePiece& piece) {
  CurvePiece first = piece, second = piece;
  const int n = piece.degree();
  for (int k = 1; k <= n; ++k) {
    for (int i = 0; i + k <= n; ++i)
      second.coefficients.col(i) =
          ((second.coefficients.col(i) + second.coefficients.col(i + 1)) / 2).eval();
    first.coefficients.col(k) = second.coefficients.col(0);
  }
  for (const Coordinate& c : space.coordinates()) {
    const auto row = static_cast<Eigen::Index>(c.first);
    first.error[row] += 0x1p-49 * (1 + piece.coefficients.row(row).cwiseAbs().maxCoeff());
    if (c.kind == Coordinate::Kind::rotation) {
      Eigen::Vector4d a = piece.coefficients.block<4, 1>(row, 0).normalized(),
                      b = piece.coefficients.block<4, 1>(row, n).normalized();
      if (a.dot(b) < 0) b = -b;
      second.coefficients.block<4, 1>(row, n) = piece.coefficients.block<4, 1>(row, n);
      first.coefficients.block<4, 1>(row, n) = second.coefficients.block<4, 1>(row, 0) = a + b;
      first.error[row] = 0x1p-48;
    }
    second.error[row] = first.error[row];
  }
  return {first, second};
}

/// Returns two bodies of twenty triangles: one about a point, the other about the origin.
std::pair<Body, Body> randomSoups(RandomTrees& random, const Vec3& center, double spread) {
  TriangleMesh meshA, meshB;
  for (int i = 0; i < 20; ++i) {
    const Vec3 c = center + random.vector(spread), d = random.vector(0.3);
    add(meshA, c, c + random.vector(0.4), c + random.vector(0.4));
    add(meshB, d, d + random.vector(0.2), d + random.vector(0.2));
  }
  return {Body("", meshA), Body("", meshB)};
}

/// A straight piece has the verdict of the edge between the same configurations. Coordinates of the
/// kind `circle` turn by less than half a turn, so edge and piece turn in the same sense.
TEST(CurveMotion, StraightPiecesHaveTheVerdictOfTheEdge) {
  RandomTrees random(test::testSeed(53));
  const int count = (test::isStressRun() ? 20'000 : 1'000) / test::kSlowdown;
  int verdicts[3] = {}, other = 0;
  QueryContext context;
  for (int n = 0; n < count; ++n) {
    random.makeTree(1 + random.randomIndex(6));
    random.makeEdge(1);
    if (random.space.ambiguous(random.from, random.to)) continue;
    CurvePiece piece = curveOfPath(random.space, {random.from, random.to}).pieces[0];
    const Scene::FramePair frames{0, random.tree.frames.size() - 1};
    EdgeMotion motion(random.tree, random.space, {&frames, 1}, random.noTube());
    const ReferenceKinematics reference(random.tree, random.space, piece);
    const auto [a, b] =
        randomSoups(random, reference.relative(0, frames.b, 0.5L).t.cast<double>(), 1);
    const MotionPair pair{&a, &b};
    MotionOptions options;
    options.tolerance = 1e-7;
    motion.set(random.from, random.to);
    const MotionVerdict edge = certifyMotion(motion, {&pair, 1}, options, context).verdict;
    ++verdicts[static_cast<int>(edge)];
    // The same line with a higher degree and rounded coefficients also has the verdict of the edge.
    for (const int degree : {1, 2, 5, 9}) {
      CurvePiece line = piece;
      line.coefficients.resize(piece.coefficients.rows(), degree + 1);
      for (int i = 0; i <= degree; ++i) {
        const double share = static_cast<double>(i) / degree;
        line.coefficients.col(i) =
            (1 - share) * piece.coefficients.col(0) + share * piece.coefficients.col(1);
      }
      for (const Coordinate& c : random.space.coordinates()) {
        if (c.kind != Coordinate::Kind::rotation) continue;
        const auto first = static_cast<Eigen::Index>(c.first);
        line.coefficients.col(0).segment<4>(first) = random.from.segment<4>(first);
        line.coefficients.col(degree).segment<4>(first) = random.to.segment<4>(first);
      }
      motion.set(line);
      const MotionVerdict verdict = certifyMotion(motion, {&pair, 1}, options, context).verdict;
      if (edge == MotionVerdict::undecided || verdict == MotionVerdict::undecided)
        ++other;
      else
        ASSERT_EQ(verdict, edge) << n << ", degree " << degree;
    }
  }
  std::cout << verdicts[0] << " free, " << verdicts[1] << " contact\n";
  EXPECT_GT(verdicts[0], count / 10);
  EXPECT_GT(verdicts[1], count / 10);
  EXPECT_LE(other, 4 + count / 1000);
}

/// Random pieces of all degrees: if the verdict is `free`, no sampled pose touches. Reversal,
/// subdivision and elevation of the degree do not change a verdict.
TEST(CurveMotion, RandomPiecesAgainstSamples) {
  RandomTrees random(test::testSeed(52));
  const int count = test::casesOf(300, 100'000);
  int verdicts[3] = {};
  QueryContext context;
  for (int n = 0; n < count; ++n) {
    random.makeTree(1 + random.randomIndex(6));
    const int degree = 1 + n % 8;
    const CurvePiece piece = smoothPiece(random, degree, std::pow(10.0, random.real(-2, 0.3)));
    const Scene::FramePair frames{0, random.tree.frames.size() - 1};
    EdgeMotion motion(random.tree, random.space, {&frames, 1}, random.noTube());
    const ReferenceKinematics reference(random.tree, random.space, piece);
    const auto soups =
        randomSoups(random, reference.relative(0, frames.b, 0.5L).t.cast<double>(), 1.5);
    const auto &a = std::get<0>(soups), &b = std::get<1>(soups);
    const MotionPair pair{&a, &b};
    MotionOptions options;
    options.tolerance = 1e-7;
    const auto verdictOf = [&](const CurvePiece& curve) {
      motion.set(curve);
      return certifyMotion(motion, {&pair, 1}, options, context);
    };
    const MotionResult r = verdictOf(piece);
    ++verdicts[static_cast<int>(r.verdict)];
    const auto touches = [&](LongReal t) {
      const MovingPose X = reference.relative(0, frames.b, t);
      return interference(Posed(a.binaryTree()),
                          Posed(b.binaryTree(), {X.m.cast<double>(), X.t.cast<double>()}), context);
    };
    CurvePiece reversed = piece, elevated = piece;
    reversed.coefficients = piece.coefficients.rowwise().reverse();
    elevated.coefficients.resize(piece.coefficients.rows(), degree + 2);
    for (int i = 0; i <= degree + 1; ++i) {
      const double share = static_cast<double>(i) / (degree + 1);
      elevated.coefficients.col(i) = share * piece.coefficients.col(std::max(i - 1, 0)) +
                                     (1 - share) * piece.coefficients.col(std::min(i, degree));
    }
    if (r.verdict != MotionVerdict::undecided) {
      ASSERT_EQ(verdictOf(reversed).verdict, r.verdict) << n;
      ASSERT_EQ(verdictOf(elevated).verdict, r.verdict) << n;
      const auto halves = halvesOf(random.space, piece);
      const MotionVerdict first = verdictOf(halves[0]).verdict,
                          second = verdictOf(halves[1]).verdict;
      if (r.verdict == MotionVerdict::free) {
        ASSERT_TRUE(first == MotionVerdict::free && second == MotionVerdict::free) << n;
      } else {
        ASSERT_TRUE(first == MotionVerdict::contact || second == MotionVerdict::contact) << n;
      }
    }
    if (r.verdict == MotionVerdict::contact) {
      ASSERT_TRUE(touches(r.time)) << n;
    }
    if (r.verdict != MotionVerdict::free) continue;
    for (int i = 0; i <= 100; ++i) ASSERT_FALSE(touches(i / 100.0L)) << n << " at " << i;
  }
  std::cout << verdicts[0] << " free, " << verdicts[1] << " contact, " << verdicts[2]
            << " undecided\n";
  EXPECT_GT(verdicts[0], count / 10);
  EXPECT_GT(verdicts[1], count / 10);
  EXPECT_LE(verdicts[2], 1 + count / 1000);
}

}  // namespace
}  // namespace corridor
