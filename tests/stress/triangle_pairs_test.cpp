// Compares the contact test with rationals, on pairs of triangles for which contact is hard to
// decide (tests/support/triangle_families.h). Swapping, rotating and scaling a pair must not change
// the verdict, and enlarging a triangle must keep a contact; this is tested, too. There are
// 50,000 pairs, or 10^7 with CORRIDOR_STRESS.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <optional>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "collision/core/rounding.h"
#include "collision/hierarchy/obb_tree.h"
#include "collision/predicates/triangle_contact.h"
#include "collision/queries/closest_points.h"
#include "collision/queries/distance_obb4.h"
#include "collision/queries/interference.h"
#include "collision/queries/interference_obb4.h"
#include "collision/queries/triangle_intersection.h"
#include "tests/support/meshes.h"
#include "tests/support/rational_contact.h"
#include "tests/support/reference_distance.h"
#include "tests/support/support.h"
#include "tests/support/triangle_families.h"

namespace corridor {
namespace {

using test::errorScale;
using test::PlacedPair;
using Random = std::mt19937_64;

bool touch(const PlacedPair& p) {
  return trianglesTouch(p.a, p.X_WA, p.b, p.X_WB);
}
PlacedPair swapped(const PlacedPair& p) {
  return {p.b, p.a, p.X_WB, p.X_WA};
}
PlacedPair turned(const PlacedPair& p, const Mat3& R) {
  return {p.a, p.b, {R * p.X_WA.m, R * p.X_WA.t}, {R * p.X_WB.m, R * p.X_WB.t}};
}

/// Returns the pair times 2^exponent, or nullopt if a number would overflow or lose bits.
std::optional<PlacedPair> scaled(const PlacedPair& p, int exponent) {
  PlacedPair q = p;
  bool exact = true;
  const auto scale = [&](double& x) {
    const double y = std::ldexp(x, exponent);
    exact = exact && std::isfinite(y) && std::ldexp(y, -exponent) == x;
    x = y;
  };
  for (Triangle* t : {&q.a, &q.b})
    for (Vec3& v : *t)
      for (double& x : v) scale(x);
  for (Vec3* t : {&q.X_WA.t, &q.X_WB.t})
    for (double& x : *t) scale(x);
  return exact ? std::optional(q) : std::nullopt;
}

/// Returns the rounding error of x + y (Knuth's TwoSum).
double lost(double x, double y) {
  const double sum = x + y, part = sum - x;
  return (x - (sum - part)) + (y - part);
}

/// Returns the triangle scaled by 2 from its first corner. The result contains the given triangle.
/// Returns nullopt if a coordinate would be rounded.
std::optional<Triangle> grown(const Triangle& t) {
  Triangle g = t;
  for (int k = 1; k < 3; ++k)
    for (int i = 0; i < 3; ++i) {
      const double d = t[k][i] - t[0][i];
      if (lost(t[k][i], -t[0][i]) != 0 || lost(t[k][i], d) != 0) return std::nullopt;
      g[k][i] += d;
    }
  return g;
}

class Pairs : public testing::TestWithParam<test::PairFamily> {
 protected:
  /// Expects the exact verdict from both predicates for the pair, and from `trianglesTouch` also
  /// for the swapped, the rotated and the scaled pair. If the triangles touch, they must also touch
  /// after triangle a is enlarged.
  void expectVerdict(Random& random, const PlacedPair& p, bool expected) {
    ASSERT_EQ(touch(p), expected);
    ASSERT_EQ(touch(swapped(p)), expected);
    ASSERT_EQ(trianglesTouchExact(p.a, p.X_WA, p.b, p.X_WB), expected);
    const Mat3 R = test::exactRotation(random);
    rotations_.insert({R.data(), R.data() + R.size()});
    PlacedPair other = turned(p, R);
    std::shuffle(other.a.begin(), other.a.end(), random);
    ASSERT_EQ(touch(other), expected) << "turned";
    if (const auto q = scaled(p, static_cast<int>(random() % 401) - 200)) {
      ASSERT_EQ(touch(*q), expected) << "scaled";
    }
    if (const auto a = grown(p.a); a && expected) {
      ASSERT_TRUE(touch({*a, p.b, p.X_WA, p.X_WB})) << "grown";
    }
  }

  /// Expects right answers of queries on trees that have one triangle each.
  static void expectQueries(Random& random, const PlacedPair& p, bool expected, bool reference) {
    const TriangleMesh meshA = meshOf(p.a), meshB = meshOf(p.b);
    const Obb4Tree a(meshA), b(meshB);
    const ObbTree binaryA(meshA), binaryB(meshB);
    QueryContext context;
    ASSERT_EQ(interference(Posed(a, p.X_WA), Posed(b, p.X_WB), context).has_value(), expected);
    ASSERT_EQ(interference(Posed(b, p.X_WB), Posed(a, p.X_WA), context).has_value(), expected);
    ASSERT_EQ(interference(Posed(binaryA, p.X_WA), Posed(binaryB, p.X_WB), context).has_value(),
              expected);
    const double d = distance(Posed(a, p.X_WA), Posed(b, p.X_WB), {}, context).distance;
    ASSERT_EQ(d == 0, expected) << d;
    ASSERT_EQ(distance(Posed(b, p.X_WB), Posed(a, p.X_WA), {}, context).distance == 0, expected);
    ASSERT_EQ(distance(Posed(binaryA, p.X_WA), Posed(binaryB, p.X_WB), {}, context).distance == 0,
              expected);
    // `off` is the error that distance.h promises. Without contact, the distance is at least the
    // smallest normal number.
    const double scale = errorScale(p.a, p.X_WA, p.b, p.X_WB);
    const double off = 1e-12 * d + 4 * kUnit * scale + 0x1p-1022;
    ASSERT_EQ(closerThan(Posed(a, p.X_WA), Posed(b, p.X_WB), 0, context), expected);
    ASSERT_TRUE(closerThan(Posed(a, p.X_WA), Posed(b, p.X_WB), d + off, context)) << d;
    ASSERT_TRUE(closerThan(Posed(binaryB, p.X_WB), Posed(binaryA, p.X_WA), d + off, context)) << d;
    const double below = d - 2 * off - 4 * kTiny;  // 4 kTiny allow for underflow in roundedUp
    if (below > 0) {
      ASSERT_FALSE(closerThan(Posed(a, p.X_WA), Posed(b, p.X_WB), below, context)) << d;
    }
    if (expected) return expectSegment(random, p, scale);
    if (reference) {
      const auto truth = test::referenceDistance(p.a, p.X_WA, p.b, p.X_WB);
      ASSERT_LE(std::abs(d - truth), off) << d << " instead of " << truth;
    }
    // Scaling is exact bit for bit as long as no intermediate result underflows.
    const int exponent = static_cast<int>(random() % 101) - 50;
    if (const auto q = scaled(p, exponent); q && d > 0x1p-400 * scale && scale > 0x1p-400) {
      ASSERT_EQ(witnessPoints(q->a, q->X_WA, q->b, q->X_WB).distance,
                std::ldexp(witnessPoints(p.a, p.X_WA, p.b, p.X_WB).distance, exponent));
    }
  }

  static void expectSegment(Random& random, const PlacedPair& p, double scale) {
    const Segment s = triangleIntersection(p.a, p.X_WA, p.b, p.X_WB),
                  exact = triangleIntersectionExact(p.a, p.X_WA, p.b, p.X_WB);
    ASSERT_LE(apart(s, exact), 0x1p-50 * scale + 0x1p-1074);
    ASSERT_LE(apart(s, triangleIntersection(p.b, p.X_WB, p.a, p.X_WA)),
              2 * 0x1p-50 * scale + 0x1p-1074);
    const Mat3 R = test::exactRotation(random);
    const PlacedPair q = turned(p, R);
    const Segment t = triangleIntersection(q.a, q.X_WA, q.b, q.X_WB);
    ASSERT_LE(apart({R * s.p, R * s.q}, t), 2 * 0x1p-50 * scale + 0x1p-1074) << "turned";
  }

  /// Returns the largest difference of any coordinate of two segments, for the order of their ends
  /// that makes it smaller.
  static double apart(const Segment& s, const Segment& t) {
    const auto off = [&](const Vec3& p, const Vec3& q) {
      return std::max((s.p - p).cwiseAbs().maxCoeff(), (s.q - q).cwiseAbs().maxCoeff());
    };
    // If two diagonals of the intersection are equally long, either may be reported. Then only the
    // lengths are compared.
    const double ends = std::min(off(t.p, t.q), off(t.q, t.p));
    const double lengths = std::abs((s.p - s.q).stableNorm() - (t.p - t.q).stableNorm());
    return std::min(ends, lengths);
  }

  static TriangleMesh meshOf(const Triangle& t) {
    TriangleMesh mesh;
    test::add(mesh, t);
    return mesh;
  }

  std::set<std::vector<double>> rotations_;  // the exact rotations that occurred
};

TEST_P(Pairs, AgainstRationals) {
  const test::PairFamily& family = GetParam();
  Random random(test::testSeed(81));
  const auto placings = test::pairPlacings();
  const int cases =
      test::casesOf(50'000, 10'000'000) / static_cast<int>(test::pairFamilies().size());
  std::vector<int> touching(placings.size()), all(placings.size());
  for (int n = 0; n < cases; ++n) {
    Triangle a, b;
    family.make(random, a, b);
    const std::size_t which = random() % placings.size();
    const test::PairPlacing& placing = placings[which];
    const PlacedPair p = placing.place(random, a, b);
    const bool expected = placing.keeps ? test::rationalContact(a, {}, b, {})
                                        : test::rationalContact(p.a, p.X_WA, p.b, p.X_WB);
    ++all[which];
    touching[which] += expected;
    expectVerdict(random, p, expected);
    if (n % 4 == 0) expectQueries(random, p, expected, n % 64 == 0);
    ASSERT_FALSE(HasFatalFailure()) << placing.name << ", case " << n;
  }
  for (std::size_t i = 0; i < placings.size(); ++i) {
    std::cout << placings[i].name << ": " << all[i] << ", touching " << touching[i] << "\n";
    EXPECT_GT(touching[i], all[i] / 50) << placings[i].name;
    EXPECT_LT(touching[i], all[i] - all[i] / 50) << placings[i].name;
  }
  EXPECT_EQ(rotations_.size(), 24U);
}
INSTANTIATE_TEST_SUITE_P(Families, Pairs,
                         testing::ValuesIn(test::pairFamilies().begin(),
                                           test::pairFamilies().end()),
                         [](const auto& family) {
                           std::string name = family.param.name;
                           std::replace(name.begin(), name.end(), ' ', '_');
                           return name;
                         });

}  // namespace
}  // namespace corridor
