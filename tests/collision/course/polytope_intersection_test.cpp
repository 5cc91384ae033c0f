#include "collision/course/polytope_intersection.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <optional>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "collision/convex/convex_distance.h"
#include "collision/convex/rational-inl.h"
#include "collision/course/exact_contact.h"
#include "collision/course/linear_program.h"
#include "collision/course/matrix_game.h"
#include "tests/collision/convex/hull_pairs.h"
#include "tests/collision/convex/posed_polytopes.h"
#include "tests/collision/convex/random_points.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using seidel::Rational;
using seidel::rational;
using test::exactDot;
using test::RandomPoints;

/// A polytope with both of its hierarchies. The object can't be moved, because the outer hierarchy
/// refers to the inner one.
struct Preprocessed {
  DobkinKirkpatrick inner;
  OuterHierarchy outer;
  explicit Preprocessed(Polytope polytope) : inner(std::move(polytope)), outer(inner) {}
  Preprocessed(const Preprocessed&) = delete;
  const Polytope& polytope() const { return inner.polytope(); }
};

std::vector<Vec3> some(const Polytope& polytope, const std::vector<std::uint32_t>& which,
                       const Transform& X) {
  std::vector<Vec3> points;
  for (const std::uint32_t v : which) points.push_back(X * polytope.vertices()[v]);
  return points;
}

struct Tally {
  int pairs = 0, meeting = 0, exact = 0;
};

/// Tests the verdict against the rational simplex method, and the witness against rationals.
/// @pre mapped vertices are doubles without rounding.
void expectRight(const Preprocessed& p, const Transform& X_WP, const Preprocessed& q,
                 const Transform& X_WQ, Tally& tally) {
  const auto a = test::mapped(p.polytope(), X_WP), b = test::mapped(q.polytope(), X_WQ);
  const bool truth = test::hullRelation<3>(a, b) != HullRelation::disjoint;
  const PolytopeIntersection found = intersection(p.inner, X_WP, q.outer, X_WQ);
  ASSERT_EQ(found.intersects, truth) << "pair " << tally.pairs;
  ASSERT_EQ(intersection(q.inner, X_WQ, p.outer, X_WP).intersects, truth)
      << "pair " << tally.pairs << ", exchanged";
  ++tally.pairs;
  tally.meeting += truth;
  tally.exact += found.exact;
  if (found.exact) return;
  if (truth) {
    EXPECT_NE(test::hullRelation<3>(some(p.polytope(), found.verticesP, X_WP),
                                    some(q.polytope(), found.verticesQ, X_WQ)),
              HullRelation::disjoint)
        << "pair " << tally.pairs;
    return;
  }
  Rational last = exactDot(found.direction_W, a[0]), first = exactDot(found.direction_W, b[0]);
  for (const Vec3& x : a) last = std::max(last, exactDot(found.direction_W, x));
  for (const Vec3& x : b) first = std::min(first, exactDot(found.direction_W, x));
  EXPECT_LT(last, first) << "pair " << tally.pairs;
}

/// Compares verdicts for boxes, polytopes of grid points, needles, nearly flat polytopes, cones,
/// prisms and random polytopes, near the origin and far away.
TEST(PolytopeIntersection, AgreesWithRationalSimplexUnderPoses) {
  test::ExactPairs random(test::testSeed(61));
  Tally tally;
  const int pairs = test::casesOf(200, 20'000);
  for (int n = 0; n < pairs; ++n) {
    const Preprocessed p(random.polytope(n % random.kKinds)),
        q(random.polytope(n / random.kKinds % random.kKinds));
    const bool isFar = n % 5 == 0;
    Transform X_WP = random.pose(0.7, isFar), X_WQ = random.pose(0.7, isFar);
    if (isFar)
      for (Transform* X : {&X_WP, &X_WQ}) X->t += Vec3(1e6, -1e6, 5e5);
    expectRight(p, X_WP, q, X_WQ, tally);
    if (HasFatalFailure()) return;
  }
  std::cout << tally.meeting << " of " << tally.pairs
            << " intersect; decided by the whole polytopes: " << tally.exact << "\n";
  EXPECT_GT(tally.meeting, pairs / 5);
  EXPECT_LT(tally.meeting, pairs * 9 / 10);
  EXPECT_LT(tally.exact, pairs / 4);
}

/// Compares verdicts for polytopes that share vertices, edges or faces, for needles, and for
/// polytopes that are nearly flat or far away.
TEST(PolytopeIntersection, AgreesWithRationalSimplexOnDegeneratePairs) {
  test::HullPairs<3> random(test::testSeed(62));
  Tally tally;
  const int tries = test::isStressRun() ? 40'000 : 900 / test::kSlowdown;
  for (int n = 0; n < tries; ++n) {
    const auto [a, b] = random.next();
    try {
      const Preprocessed p{Polytope(a)}, q{Polytope(b)};
      expectRight(p, {}, q, {}, tally);
    } catch (const std::invalid_argument&) {  // all on one plane
    }
    if (HasFatalFailure()) return;
  }
  std::cout << tally.meeting << " of " << tally.pairs
            << " intersect; decided by the whole polytopes: " << tally.exact << "\n";
  EXPECT_GT(tally.pairs, tries / 6);
  EXPECT_GT(tally.meeting, tally.pairs / 5);
  EXPECT_LT(tally.meeting, tally.pairs * 9 / 10);
}

/// The tolerance of this test. Coordinates of points and half-spaces are below 4. The search has
/// some 100 successive roundings, and each error grows if planes are nearly parallel. A wrong plane
/// or point is off by far more.
constexpr double kClose = 1e-9;

/// Tests the two invariants of the search after a step, and that at most one vertex or half-space
/// violates the current plane or point.
void expectInvariants(const PolytopePruning& left, const Preprocessed& p, const Transform& X_QP,
                      const Preprocessed& q) {
  const DobkinKirkpatrick& polar = *q.outer.polar();
  ConvexPart polytopeP;  // P_i
  std::vector<HalfSpace<3>> polyhedronQ;
  int newBeyond = 0;
  for (std::uint32_t v = 0; v < p.polytope().vertices().size(); ++v) {
    const Vec3 x = X_QP * p.polytope().vertices()[v];
    if (p.inner.lastLevel(v) >= left.levelP) {
      polytopeP.points.push_back(x);
      if (left.apart) {
        EXPECT_LE(left.normal_Q.dot(x) - left.offset, kClose);
      }
    } else if (left.apart && p.inner.lastLevel(v) + 1 == left.levelP) {
      newBeyond += left.normal_Q.dot(x) - left.offset > kClose;
    }
  }
  for (std::uint32_t k = 0; k < polar.polytope().vertices().size(); ++k) {
    const Vec3& y = polar.polytope().vertices()[k];
    const double outside = y.dot(left.point_Q - q.outer.center()) - 1;
    if (polar.lastLevel(k) >= left.levelQ) {
      polyhedronQ.push_back({y, 1 + y.dot(q.outer.center())});
      if (!left.apart) {
        EXPECT_LE(outside, kClose * y.norm());
      }
    } else if (!left.apart && polar.lastLevel(k) + 1 == left.levelQ) {
      newBeyond += outside > kClose * y.norm();
    }
  }
  EXPECT_LE(newBeyond, 1);
  if (left.apart) {
    // Q_j may be unbounded. Then the effect of the rounding of the normal has no bound.
    for (int k = 0; k < 3; ++k)
      for (const double s : {1.0, -1.0}) polyhedronQ.push_back({s * Vec3::Unit(k), 100});
    const auto lowest = solveLinearProgram<3>(polyhedronQ, Vec3(-left.normal_Q));
    ASSERT_EQ(lowest.status, LinearProgramStatus::optimal);
    EXPECT_GE(left.normal_Q.dot(lowest.x) - left.offset, -kClose);
  } else {
    const ConvexPart point{{left.point_Q}, 0, false};
    EXPECT_LE(convexDistance({polytopeP, {}}, {point, {}}).distance, kClose);
  }
}

TEST(PolytopeIntersection, EachPruningKeepsBothInvariants) {
  RandomPoints random(test::testSeed(63));
  const int pairs = test::isStressRun() ? 3000 : 64 / test::kSlowdown;
  int steps[2] = {0, 0}, changes = 0, deepest = 0;
  for (int n = 0; n < pairs; ++n) {
    const std::size_t size = n % 8 == 0 ? 1000 : 20 + 10 * static_cast<std::size_t>(n % 7);
    const Preprocessed p{Polytope(random.onSphere(size))}, q{Polytope(random.onSphere(size))};
    // The pairs range from far apart to deep overlap; most of them nearly touch.
    const double gap = n % 3 == 0 ? random.real() : std::pow(10.0, -1 - n % 5) * random.real();
    Transform X_QP;
    X_QP.m = Eigen::Quaterniond(random.real(), random.real(), random.real(), random.real())
                 .normalized()
                 .toRotationMatrix();
    X_QP.t = (2 + gap) * random.direction();
    std::vector<PolytopePruning> trace;
    const PolytopeIntersection found = intersection(p.inner, X_QP, q.outer, {}, &trace);
    ASSERT_FALSE(trace.empty());
    std::size_t levelP = p.inner.levels() - 1, levelQ = q.outer.polar()->levels() - 1;
    for (std::size_t i = 0; i < trace.size(); ++i) {
      const PolytopePruning& left = trace[i];
      expectInvariants(left, p, X_QP, q);
      // A step descends in one hierarchy: to the level above the level of the vertex or half-space
      // that violates the current plane or point.
      EXPECT_LE(left.levelP, levelP);
      EXPECT_LE(left.levelQ, levelQ);
      EXPECT_EQ(left.apart ? left.levelQ : left.levelP, left.apart ? levelQ : levelP);
      ++steps[left.apart];
      changes += i > 0 && left.apart != trace[i - 1].apart;
      levelP = left.levelP, levelQ = left.levelQ;
      if (i + 1 < trace.size()) --(left.apart ? levelP : levelQ);
      if (HasFailure()) FAIL() << "pair " << n << ", step " << i;
    }
    if (!found.exact) {
      EXPECT_EQ(found.intersects, !trace.back().apart);
      EXPECT_EQ(found.intersects ? levelQ : levelP, 0u);
    }
    deepest = std::max(deepest, found.steps);
  }
  std::cout << steps[1] << " separations, " << steps[0] << " intersections, " << changes
            << " changes; at most " << deepest << " steps\n";
  EXPECT_GT(steps[0], pairs / 2);
  EXPECT_GT(steps[1], pairs / 2);
  EXPECT_GT(changes, pairs / 2);
}

/// The number of steps grows like the logarithm of the number of vertices, even if the polytopes
/// nearly touch.
TEST(PolytopeIntersection, TakesLogarithmicallyManySteps) {
  RandomPoints random(test::testSeed(64));
  for (const std::size_t n : {10u, 100u, 1000u, 4000u / test::kSlowdown}) {
    const Preprocessed p{Polytope(random.onSphere(n))}, q{Polytope(random.onSphere(n))};
    const std::size_t levels = p.inner.levels() + q.outer.polar()->levels();
    int most = 0, sum = 0, exact = 0;
    constexpr int kPairs = 100;
    for (int k = 0; k < kPairs; ++k) {
      const Vec3 d = random.direction();
      Transform X{Mat3::Identity(), 4 * d};
      for (int i = 0; i < 30; ++i) X.t -= d * convexDistance({p.inner, X}, {q.inner, {}}).distance;
      const double gap = std::pow(10.0, -1 - k % 12);
      X.t += (k % 2 ? gap : -gap) * d;
      const PolytopeIntersection found = intersection(p.inner, X, q.outer, {});
      EXPECT_EQ(found.intersects, convexHullsTouch({p.inner, X}, {q.inner, {}})) << gap;
      most = std::max(most, found.steps);
      sum += found.steps;
      exact += found.exact;
      // Few vertices prove that there is a common point.
      EXPECT_LE(found.verticesP.size(), 4u * static_cast<std::size_t>(found.steps));
      EXPECT_LE(found.verticesQ.size(), 13u);
    }
    std::cout << n << " vertices, " << levels << " levels: at most " << most << " steps, "
              << sum / kPairs << " in the mean; decided by the whole polytopes: " << exact << "\n";
    EXPECT_LE(static_cast<std::size_t>(most), levels);
    EXPECT_LE(levels, 12 * std::log2(static_cast<double>(n)));
    EXPECT_LE(exact, kPairs / 5);
  }
}

Polytope box(const Vec3& low, const Vec3& high) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i)
    corners.emplace_back(i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(),
                         i & 4 ? high.z() : low.z());
  return Polytope(corners);
}

/// Boxes that share a vertex, an edge or a face, and boxes that are moved from there by one unit in
/// the last place.
TEST(PolytopeIntersection, OneUlpDecides) {
  for (const double far : {0.0, 1e6}) {
    const Vec3 o = Vec3::Constant(far), one = Vec3::Ones();
    const Preprocessed p(box(o, o + one));
    for (int shared = 1; shared < 8; ++shared) {  // the axes along which they only touch
      Vec3 low = o, high = o + one;
      for (int k = 0; k < 3; ++k)
        if (shared & 1 << k) low[k] = o[k] + 1, high[k] = o[k] + 2;
      const Preprocessed touching(box(low, high));
      EXPECT_TRUE(intersection(p.inner, {}, touching.outer, {}).intersects) << shared;
      EXPECT_TRUE(intersection(touching.inner, {}, p.outer, {}).intersects) << shared;
      for (int k = 0; k < 3; ++k) {
        if (!(shared & 1 << k)) continue;
        Vec3 apart = low;
        apart[k] = std::nextafter(low[k], HUGE_VAL);
        const Preprocessed q(box(apart, high));
        EXPECT_FALSE(intersection(p.inner, {}, q.outer, {}).intersects) << shared;
        EXPECT_FALSE(intersection(q.inner, {}, p.outer, {}).intersects) << shared;
      }
    }
  }
}

TEST(PolytopeIntersection, OneContainsTheOther) {
  RandomPoints random(test::testSeed(65));
  const Preprocessed big(box(Vec3::Constant(-10), Vec3::Constant(10))),
      same(box(Vec3::Constant(-10), Vec3::Constant(10))), small{Polytope(random.onSphere(200))};
  for (const Vec3& t : {Vec3(0, 0, 0), Vec3(8.9, -8.9, 8.9), Vec3(3, 0, 0)}) {
    EXPECT_TRUE(intersection(small.inner, {Mat3::Identity(), t}, big.outer, {}).intersects);
    EXPECT_TRUE(intersection(big.inner, {}, small.outer, {Mat3::Identity(), t}).intersects);
    EXPECT_TRUE(intersection(big.inner, {}, same.outer, {Mat3::Identity(), t}).intersects);
  }
}

/// Under maps that the search cannot use, the exact test of all vertices decides.
TEST(PolytopeIntersection, TakesAnyFiniteMap) {
  const Preprocessed p(box(-Vec3::Ones(), Vec3::Ones())), q(box(-Vec3::Ones(), Vec3::Ones()));
  Transform flat;
  flat.m(2, 2) = 0;
  flat.t.z() = 1;
  EXPECT_TRUE(intersection(p.inner, {}, q.outer, flat).intersects);
  flat.t.z() = std::nextafter(1.0, 2.0);
  const PolytopeIntersection apart = intersection(p.inner, {}, q.outer, flat);
  EXPECT_FALSE(apart.intersects);
  EXPECT_TRUE(apart.exact);
  Transform sheared;
  sheared.m(0, 2) = 3;
  sheared.t.x() = 4;
  EXPECT_TRUE(intersection(p.inner, {}, q.outer, sheared).intersects);
  sheared.t.x() = 6.001;
  EXPECT_FALSE(intersection(p.inner, {}, q.outer, sheared).intersects);
  Transform none;
  none.t.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(intersection(p.inner, none, q.outer, {}), std::invalid_argument);
}

TEST(OuterHierarchy, PassesTheCheck) {
  test::ExactPairs random(test::testSeed(66));
  for (int n = 0; n < 70; ++n) {
    const Preprocessed p(random.polytope(n % random.kKinds));
    EXPECT_EQ(p.outer.check(), std::nullopt) << n;
    ASSERT_NE(p.outer.polar(), nullptr) << n;
    // Each vertex of Q is in all half-spaces, and each half-space has the vertices of its face on
    // its plane, up to the rounding of y.
    const auto halves = p.outer.polar()->polytope().vertices();
    for (std::uint32_t k = 0; k < halves.size(); ++k) {
      for (const Vec3& x : p.polytope().vertices())
        EXPECT_LE(halves[k].dot(x - p.outer.center()), 1 + 1e-11) << n;
      for (const std::uint32_t v : p.outer.face(k))
        EXPECT_NEAR(halves[k].dot(p.polytope().vertices()[v] - p.outer.center()), 1, 1e-11) << n;
    }
  }
  const Preprocessed cube(box(Vec3::Zero(), Vec3::Ones()));
  EXPECT_EQ(cube.outer.faceCount(), 6u);
  EXPECT_EQ(cube.outer.polar()->polytope().vertices().size(), 6u);
  EXPECT_EQ(cube.outer.face(0).size(), 4u);
  RandomPoints sphere(test::testSeed(67));
  const Preprocessed many{Polytope(sphere.onSphere(800))};
  EXPECT_EQ(many.outer.check(), std::nullopt);
  EXPECT_EQ(many.outer.polar()->polytope().vertices().size(), many.polytope().faces().size());
}

/// A polytope that is flat in double precision has no polar polytope. The verdict must be exact
/// nevertheless.
TEST(OuterHierarchy, FlatPolytopesHaveNoPolar) {
  const double e = std::numeric_limits<double>::denorm_min();
  const std::vector<Vec3> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, e}};
  const Preprocessed flat{Polytope(points)}, q(box(Vec3(0, 0, e), Vec3::Ones()));
  EXPECT_EQ(flat.outer.polar(), nullptr);
  EXPECT_TRUE(intersection(q.inner, {}, flat.outer, {}).intersects);
  EXPECT_FALSE(intersection(q.inner, {Mat3::Identity(), Vec3(0, 0, 1)}, flat.outer, {}).intersects);
}

/// Tests the weights of both players: the weights of each player prove that the other player's
/// weights are optimal.
TEST(MatrixGame, WeightsAreOptimal) {
  RandomPoints random(test::testSeed(68));
  for (int n = 0; n < 2000; ++n) {
    MatrixGame game;
    game.rows = 1 + static_cast<std::size_t>(n) % MatrixGame::kMost;
    game.columns = 1 + static_cast<std::size_t>(n / 10) % MatrixGame::kMost;
    for (std::size_t i = 0; i < game.rows; ++i)
      for (std::size_t j = 0; j < game.columns; ++j)
        game.entry[i][j] = n % 3 == 0 ? std::round(2 * random.real()) : random.real();
    game.solve();
    double above = -HUGE_VAL, below = HUGE_VAL, sumRows = 0, sumColumns = 0;
    for (std::size_t i = 0; i < game.rows; ++i) {
      double sum = 0;
      for (std::size_t j = 0; j < game.columns; ++j) sum += game.columnWeight[j] * game.entry[i][j];
      above = std::max(above, sum);
      EXPECT_GE(game.rowWeight[i], 0);
      sumRows += game.rowWeight[i];
    }
    for (std::size_t j = 0; j < game.columns; ++j) {
      double sum = 0;
      for (std::size_t i = 0; i < game.rows; ++i) sum += game.rowWeight[i] * game.entry[i][j];
      below = std::min(below, sum);
      EXPECT_GE(game.columnWeight[j], 0);
      sumColumns += game.columnWeight[j];
    }
    ASSERT_NEAR(sumRows, 1, 1e-14) << n;
    ASSERT_NEAR(sumColumns, 1, 1e-14) << n;
    ASSERT_NEAR(above, below, 1e-11) << n;  // weak duality: below ≤ value ≤ above
  }
}

}  // namespace
}  // namespace corridor
