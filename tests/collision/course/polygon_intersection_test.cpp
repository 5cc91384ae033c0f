#include "collision/course/polygon_intersection.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <optional>
#include <random>
#include <span>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "tests/collision/convex/hull_pairs.h"
#include "tests/support/rational_program.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

class RandomPolygons {
 public:
  explicit RandomPolygons(std::uint64_t seed) : engine_(seed) {}
  std::uint64_t below(std::uint64_t n) { return engine_() % n; }
  double real() { return std::uniform_real_distribution(-1.0, 1.0)(engine_); }

  /// Returns a polygon of about n vertices: on a circle or ellipse, or on a small or a large grid.
  std::optional<ConvexPolygon> polygon(std::size_t n, int kind, const Vec2& center) {
    std::vector<Vec2> points;
    for (std::size_t i = 0; i < n; ++i) {
      const double angle = M_PI * real();
      const Vec2 u(std::cos(angle), std::sin(angle));
      if (kind == 0) points.push_back(center + u);
      if (kind == 1) points.push_back(center + Vec2(u.x(), 0.01 * u.y()));
      if (kind == 2) points.push_back((10 * center + 3 * u).array().round());
      if (kind == 3) points.push_back((1e5 * (center + u)).array().round());
    }
    try {
      return ConvexPolygon(points);
    } catch (const std::invalid_argument&) {
      return std::nullopt;
    }
  }

 private:
  std::mt19937_64 engine_;
};

std::vector<Vec2> vertices(const ConvexPolygon& polygon) {
  return {polygon.vertices().begin(), polygon.vertices().end()};
}

TEST(ConvexPolygon, HullsAreExact) {
  RandomPolygons random(test::testSeed(41));
  for (int n = 0; n < 300; ++n) {
    const auto polygon = random.polygon(3 + random.below(30), n % 4, {random.real(), 0});
    if (!polygon) continue;
    EXPECT_EQ(polygon->check(), std::nullopt) << n;
  }
  // Collinear and equal points do not become vertices.
  const std::vector<Vec2> square = {{0, 0}, {1, 0}, {2, 0}, {2, 2}, {1, 1}, {0, 2}, {0, 1}, {2, 0}};
  EXPECT_EQ(vertices(ConvexPolygon(square)), (std::vector<Vec2>{{0, 0}, {2, 0}, {2, 2}, {0, 2}}));
  EXPECT_THROW(ConvexPolygon(std::vector<Vec2>{{0, 0}, {1, 1}, {3, 3}}), std::invalid_argument);
  EXPECT_THROW(ConvexPolygon(std::vector<Vec2>{}), std::invalid_argument);
  EXPECT_THROW(ConvexPolygon(std::vector<Vec2>{{0, 0}, {1, std::nan("")}, {3, 4}}),
               std::invalid_argument);
}

TEST(ConvexPolygon, ExtremeVertices) {
  RandomPolygons random(test::testSeed(42));
  for (int n = 0; n < 2000; ++n) {
    const auto polygon = random.polygon(3 + random.below(n % 9 ? 12 : 300), n % 4, {0.1, 0.2});
    if (!polygon) continue;
    for (int k = 0; k < 20; ++k) {
      Vec2 d(random.real(), random.real());
      if (k % 4 == 1) d = d.array().round();
      if (k % 4 == 2) {  // orthogonal to an edge
        const std::size_t i = random.below(polygon->size());
        const Vec2 edge = (*polygon)[i + 1] - (*polygon)[i];
        d = Vec2(edge.y(), -edge.x()) * (k % 8 == 2 ? 1 : -1);
      }
      const Vec2 found = (*polygon)[polygon->extreme(d)];
      for (const Vec2& v : polygon->vertices()) {
        const long double gap = static_cast<long double>(d.x()) * (v.x() - found.x()) +
                                static_cast<long double>(d.y()) * (v.y() - found.y());
        ASSERT_LE(gap, 1e-16L * d.norm() * (1 + v.norm())) << n;
      }
    }
  }
}

/// Compares answers with the rational simplex method, and tests the witness of each answer.
TEST(PolygonIntersection, AgreesWithRationalSimplex) {
  RandomPolygons random(test::testSeed(43));
  const int pairs = test::casesOf(280, 100'000);
  int meeting = 0, exact = 0;
  for (int n = 0; n < pairs; ++n) {
    const auto p = random.polygon(3 + random.below(20), n % 4, {0, 0});
    const auto q =
        random.polygon(3 + random.below(20), n % 4, 2.2 * Vec2(random.real(), random.real()));
    if (!p || !q) continue;
    const PolygonIntersection found = intersection(*p, *q);
    const bool truth = test::hullRelation<2>(vertices(*p), vertices(*q)) != HullRelation::disjoint;
    ASSERT_EQ(found.intersects, truth) << "pair " << n;
    meeting += truth;
    exact += found.exact;
    if (truth) {
      std::vector<Vec2> a, b;
      for (const std::size_t i : found.verticesP) a.push_back((*p)[i]);
      for (const std::size_t i : found.verticesQ) b.push_back((*q)[i]);
      EXPECT_NE(test::hullRelation<2>(a, b), HullRelation::disjoint) << "pair " << n;
    } else if (!found.exact) {
      const double last = found.direction.dot((*p)[found.p]),
                   first = found.direction.dot((*q)[found.q]);
      EXPECT_LT(last, first) << "pair " << n;
    }
  }
  std::cout << meeting << " of " << pairs << " intersect; decided by all vertices: " << exact
            << "\n";
  EXPECT_GT(meeting, pairs / 5);
  EXPECT_LT(exact, pairs / 10);
}

/// Returns whether the hull of the remaining vertices of p meets the intersection of the
/// half-planes of the remaining edges of q. @pre all coordinates are integers below 2^20, so that
/// the half-planes are exact.
bool partsMeet(const ConvexPolygon& p, const ConvexPolygon& q, const PolygonPruning& left) {
  // The point Σ λ_i p_i is in the half-plane n_k·x ≤ b_k of each edge k, with the slack s_k: Σ λ_i
  // (n_k·p_i) + s_k = b_k, Σ λ_i = 1, and all λ_i ≥ 0 and s_k ≥ 0.
  const std::size_t edges = std::min(left.q[1] - left.q[0] + 1, q.size());
  std::vector<std::vector<double>> columns;
  std::vector<double> right;
  for (std::size_t i = left.p[0]; i <= left.p[1] && i < left.p[0] + p.size(); ++i)
    columns.emplace_back();
  const std::size_t count = columns.size();
  columns.resize(count + edges, std::vector<double>(edges + 1, 0.0));
  for (std::size_t k = 0; k < edges; ++k) {
    const Vec2 a = q[left.q[0] + k], d = q[left.q[0] + k + 1] - a;
    const Vec2 normal(d.y(), -d.x());
    for (std::size_t i = 0; i < count; ++i) columns[i].push_back(normal.dot(p[left.p[0] + i]));
    columns[count + k][k] = 1;
    right.push_back(normal.dot(a));
  }
  for (std::size_t i = 0; i < count; ++i) columns[i].push_back(1);
  right.push_back(1);
  return test::hasSolution(columns, right);
}

/// Tests the invariant of the algorithm: after each step, the remaining part of P meets the
/// remaining part of Q if and only if P meets Q.
TEST(PolygonIntersection, EachPruningKeepsTheAnswer) {
  RandomPolygons random(test::testSeed(44));
  const int pairs = test::casesOf(50, 3'000);
  std::size_t steps = 0;
  for (int n = 0; n < pairs; ++n) {
    const auto p = random.polygon(3 + random.below(60), 3, {0, 0});
    const double angle = M_PI * random.real(),
                 gap = n % 2 ? 1.99 : 1.5 + 0.6 * std::abs(random.real());
    const auto q =
        random.polygon(3 + random.below(60), 3, gap * Vec2(std::cos(angle), std::sin(angle)));
    if (!p || !q) continue;
    std::vector<PolygonPruning> trace;
    const PolygonIntersection found = intersection(*p, *q, &trace);
    PolygonPruning before{{0, p->size()}, {0, q->size()}};
    for (const PolygonPruning& left : trace) {
      ++steps;
      EXPECT_EQ(partsMeet(*p, *q, left), found.intersects) << "pair " << n;
      EXPECT_TRUE((left.p == before.p) != (left.q == before.q)) << "pair " << n;
      EXPECT_LE(left.p[1] - left.p[0], before.p[1] - before.p[0]) << "pair " << n;
      EXPECT_LE(left.q[1] - left.q[0], before.q[1] - before.q[0]) << "pair " << n;
      before = left;
    }
  }
  std::cout << steps << " steps in " << pairs << " pairs\n";
  EXPECT_GT(steps, static_cast<std::size_t>(pairs));
}

/// Tests what the header says about each step: what it prunes of one polygon cannot decide,
/// whatever the other polygon has lost; and it halves a chain. (The first step of Q leaves the
/// edges between two extreme vertices along coordinate axes instead, which turn by less than a
/// quarter turn.) A chain of P is inside P, and a chain of half-planes contains Q. So the chain of
/// P could only miss Q, which P meets, and the chain of Q could only meet P, which is disjoint from
/// Q.
TEST(PolygonIntersection, EachStepPrunesHalfAndWhatIsPrunedCannotDecide) {
  RandomPolygons random(test::testSeed(47));
  const int pairs = test::casesOf(500, 10'000), exact = test::casesOf(30, 1'000);
  int stepsP = 0, stepsQ = 0, exactP = 0, exactQ = 0;
  for (int n = 0; n < pairs; ++n) {
    const auto p = random.polygon(3 + random.below(40), 3, {0, 0});
    const double angle = M_PI * random.real(), gap = 2.05 - 0.3 * std::abs(random.real());
    const auto q =
        random.polygon(3 + random.below(40), 3, gap * Vec2(std::cos(angle), std::sin(angle)));
    if (!p || !q) continue;
    std::vector<PolygonPruning> trace;
    const bool meet = intersection(*p, *q, &trace).intersects;
    const PolygonPruning whole{{0, p->size()}, {0, q->size()}};
    PolygonPruning before = whole;
    for (const PolygonPruning& left : trace) {
      if (left.q == before.q) {
        ++stepsP;
        EXPECT_LE(left.p[1] - left.p[0], (before.p[1] - before.p[0] + 1) / 2) << "pair " << n;
        if (meet && exactP++ < exact) {
          EXPECT_TRUE(partsMeet(*p, *q, {left.p, whole.q})) << "pair " << n;
        }
      } else {
        ++stepsQ;
        if (before.q == whole.q) {
          const Vec2 d = (*q)[left.q[0] + 1] - (*q)[left.q[0]],
                     e = (*q)[left.q[1] + 1] - (*q)[left.q[1]];
          EXPECT_GT(d.dot(e), 0) << "pair " << n;
        } else {
          EXPECT_LE(left.q[1] - left.q[0], (before.q[1] - before.q[0] + 1) / 2) << "pair " << n;
        }
        if (!meet && exactQ++ < exact) {
          EXPECT_FALSE(partsMeet(*p, *q, {whole.p, left.q})) << "pair " << n;
        }
      }
      before = left;
    }
  }
  std::cout << stepsP << " steps of P and " << stepsQ << " steps of Q in " << pairs << " pairs; "
            << exactP << " and " << exactQ << " could decide\n";
  EXPECT_GE(exactP, exact);
  EXPECT_GE(exactQ, exact);
}

/// The number of steps grows like the logarithm of the number of vertices, even if the polygons
/// nearly touch.
TEST(PolygonIntersection, TakesLogarithmicallyManySteps) {
  RandomPolygons random(test::testSeed(45));
  const int count = test::casesOf(24, 100);  // the gap has one of twelve sizes, and either sign
  for (const std::size_t n : {10u, 1000u, 100'000u / test::kSlowdown}) {
    std::vector<Vec2> points;
    for (std::size_t i = 0; i < n; ++i) {
      const double angle =
          2 * M_PI * (static_cast<double>(i) + 0.4 * random.real()) / static_cast<double>(n);
      points.emplace_back(std::cos(angle), std::sin(angle));
    }
    const ConvexPolygon p(points);
    int most = 0;
    for (int k = 0; k < count; ++k) {
      const double angle = M_PI * random.real(), gap = std::pow(10.0, -1 - k % 12);
      std::vector<Vec2> moved = points;
      for (Vec2& x : moved)
        x += (2 + (k % 2 ? gap : -gap)) * Vec2(std::cos(angle), std::sin(angle));
      most = std::max(most, intersection(p, ConvexPolygon(moved)).steps);
    }
    std::cout << n << " vertices: at most " << most << " steps\n";
    EXPECT_LE(most, 3 * std::log2(static_cast<double>(n)) + 4);
  }
}

/// A vertex is on a slanted edge, up to rounding: doubles cannot decide whether the vertex is
/// inside the other polygon.
TEST(PolygonIntersection, VerticesNearEdges) {
  RandomPolygons random(test::testSeed(46));
  int meeting = 0;
  const int pairs = 400 / test::kSlowdown + 10;
  for (int n = 0; n < pairs; ++n) {
    const Vec2 a(random.real(), random.real()), b(random.real(), random.real());
    const double share = 0.5 + 0.4 * random.real();
    const Vec2 tip = a + share * (b - a), out(b.y() - a.y(), a.x() - b.x());
    const ConvexPolygon p(std::vector<Vec2>{a, b, a - out}),
        q(std::vector<Vec2>{tip, tip + out, b + out});
    const bool truth = test::hullRelation<2>(vertices(p), vertices(q)) != HullRelation::disjoint;
    ASSERT_EQ(intersection(p, q).intersects, truth) << n;
    meeting += truth;
  }
  EXPECT_GT(meeting, pairs / 10);
  EXPECT_LT(meeting, pairs * 9 / 10);
}

TEST(PolygonIntersection, OneUlpDecides) {
  const std::vector<Vec2> square = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  const auto spike = [](double x) { return std::vector<Vec2>{{x, 0.3}, {2, 0}, {2, 1}}; };
  const ConvexPolygon p(square);
  EXPECT_TRUE(intersection(p, ConvexPolygon(spike(1))).intersects);
  EXPECT_FALSE(intersection(p, ConvexPolygon(spike(std::nextafter(1.0, 2.0)))).intersects);
}

}  // namespace
}  // namespace corridor
