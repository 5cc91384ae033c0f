// Compares the verdicts of the separating-axis test of two polytopes with the rational simplex
// method, and its witnesses with long double.
#include "collision/course/separating_axes.h"

#include <cmath>
#include <iostream>
#include <stdexcept>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "collision/core/rounding.h"
#include "tests/collision/convex/hull_pairs.h"
#include "tests/collision/convex/posed_polytopes.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::ExactPairs;
using test::Vec3L;

/// Returns the least of n·(q − p) over the vertices p of a and q of b.
long double gapAlong(const Vec3L& n, const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  long double most = -HUGE_VALL, least = HUGE_VALL;
  for (const Vec3& p : a) most = std::max(most, n.dot(p.cast<long double>()));
  for (const Vec3& q : b) least = std::min(least, n.dot(q.cast<long double>()));
  return least - most;
}

/// Returns the axis of a pair of features, in long double.
Vec3L axisOf(const PolytopeFeatures& a, const std::vector<Vec3>& p, const PolytopeFeatures& b,
             const std::vector<Vec3>& q, const SeparatingAxis& axis) {
  const auto normal = [](const PolytopeFeatures& shape, const std::vector<Vec3>& x,
                         std::uint32_t f) {
    const Polytope::Face& c = shape.polytope().faces()[f];
    const Vec3L origin = x[c[0]].cast<long double>();
    return Vec3L((x[c[1]].cast<long double>() - origin)
                     .cross(x[c[2]].cast<long double>() - origin)
                     .normalized());
  };
  const auto along = [](const PolytopeFeatures& shape, const std::vector<Vec3>& x,
                        std::uint32_t h) {
    return Vec3L(x[shape.head(h)].cast<long double>() - x[shape.tail(h)].cast<long double>());
  };
  if (axis.a.kind == Feature::Kind::face) return normal(a, p, axis.a.index);
  if (axis.b.kind == Feature::Kind::face) return -normal(b, q, axis.b.index);
  const Vec3L n = along(a, p, axis.a.index).cross(along(b, q, axis.b.index)).normalized();
  return n.dot(axis.normal_W.cast<long double>()) < 0 ? Vec3L(-n) : n;
}

TEST(SeparatingAxes, AgreesWithTheRationalSimplexMethod) {
  ExactPairs make(test::testSeed(71));
  const int pairs = test::casesOf(600, 100'000);
  int touching = 0, byEdges = 0, again = 0;
  for (int n = 0; n < pairs; ++n) {
    const Polytope a = make.polytope(make.pick(ExactPairs::kKinds)),
                   b = make.polytope(make.pick(ExactPairs::kKinds));
    const PolytopeFeatures fa(a), fb(b);
    const bool away = make.pick(4) == 0;
    Transform X_WA = make.pose(1, away), X_WB = make.pose(1.5, away);
    for (Transform* X : {&X_WA, &X_WB})
      if (away) X->t += Vec3(1e6, -1e6, 5e5);
    const std::vector<Vec3> p = test::mapped(a, X_WA), q = test::mapped(b, X_WB);
    const SeparatingAxis found = separatingAxis(fa, X_WA, fb, X_WB);
    const bool touch = test::hullRelation<3>(p, q) != HullRelation::disjoint;
    ASSERT_EQ(found.separated, !touch) << n;
    touching += touch;
    if (touch) {
      ASSERT_EQ(found.faces, a.faces().size() + b.faces().size());
      continue;
    }
    byEdges += found.a.kind == Feature::Kind::edge;
    const Vec3L axis = axisOf(fa, p, fb, q, found);
    ASSERT_GT(gapAlong(axis, p, q), 0) << n;
    ASSERT_LT((axis - found.normal_W.cast<long double>()).norm(), 1e-6) << n;
    // If the next test starts with the axis that was found, it ends at once. At another pose, a
    // test that starts with this axis has the verdict of a test without a given axis.
    const SeparatingAxis next = separatingAxis(fa, X_WA, fb, X_WB, &found);
    ASSERT_TRUE(next.separated && next.faces + next.edgePairs == 1) << n;
    const Transform X_WC = make.pose(1.5);
    ASSERT_EQ(separatingAxis(fa, X_WA, fb, X_WC, &found).separated,
              separatingAxis(fa, X_WA, fb, X_WC).separated);
    ++again;
  }
  std::cout << touching << " of " << pairs << " touch; " << byEdges << " axes are of two edges\n";
  EXPECT_GT(touching, pairs / 10);
  EXPECT_GT(again, pairs / 10);
  EXPECT_GT(byEdges, pairs / 100);
}

/// Two boxes with a gap between two edges that cross. Only the cross product of these edges is a
/// separating axis.
TEST(SeparatingAxes, TwoCrossedEdgesNeedTheirProduct) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i)
    corners.emplace_back(i & 1 ? 4 : -4, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5);
  const Polytope box(corners);
  const PolytopeFeatures f(box);
  const double turn = 0.25 * std::numbers::pi;
  const Mat3 m = Eigen::AngleAxisd(turn, Vec3::UnitX()).toRotationMatrix();
  const Mat3 across = Eigen::AngleAxisd(2 * turn, Vec3::UnitZ()).toRotationMatrix() * m;
  for (const double gap : {1e-3, 1e-9, -1e-9, -1e-3}) {
    const SeparatingAxis found =
        separatingAxis(f, {m, Vec3::Zero()}, f, {across, {0, 0, std::sqrt(2.0) + gap}});
    EXPECT_EQ(found.separated, gap > 0) << gap;
    EXPECT_EQ(found.a.kind == Feature::Kind::edge, gap > 0) << gap;
    EXPECT_GE(found.edgePairs, 1u);
  }
}

/// Scaling by a power of 2 rounds nothing, so the verdicts must be those of the unscaled polytopes.
TEST(SeparatingAxes, TakesMapsOfAnyScale) {
  ExactPairs make(test::testSeed(72));
  int touching = 0;
  const int pairs = 60;
  for (int n = 0; n < pairs; ++n) {
    const Polytope a = make.polytope(make.pick(ExactPairs::kKinds)),
                   b = make.polytope(make.pick(ExactPairs::kKinds));
    const PolytopeFeatures fa(a), fb(b);
    const Transform X_WA = make.pose(1), X_WB = make.pose(1.5);
    const bool separated = separatingAxis(fa, X_WA, fb, X_WB).separated;
    touching += !separated;
    for (const double scale : {0x1p400, 0x1p-400}) {
      const Transform Y_WA{scale * X_WA.m, scale * X_WA.t}, Y_WB{scale * X_WB.m, scale * X_WB.t};
      ASSERT_EQ(separatingAxis(fa, Y_WA, fb, Y_WB).separated, separated) << n << ", " << scale;
    }
  }
  EXPECT_TRUE(touching > 0 && touching < pairs) << touching;
}

TEST(SeparatingAxes, RefusesMapsThatMirrorOrFlatten) {
  const std::vector<Vec3> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const Polytope t(corners);
  const PolytopeFeatures f(t);
  const Transform mirrored{-Mat3::Identity(), Vec3::Zero()};
  EXPECT_THROW(separatingAxis(f, mirrored, f, {}), std::invalid_argument);
  const Transform infinite{Mat3::Identity(), {HUGE_VAL, 0, 0}};
  EXPECT_THROW(separatingAxis(f, {}, f, infinite), std::invalid_argument);
  const Transform flat{Vec3(1, 1, 0).asDiagonal().toDenseMatrix(), Vec3::Zero()};
  EXPECT_THROW(separatingAxis(f, flat, f, {}), std::invalid_argument);
  const Transform zero{Mat3::Zero(), Vec3::Zero()};
  EXPECT_THROW(separatingAxis(f, zero, f, {}), std::invalid_argument);
  const Transform thin{Vec3(1, 1, 1e-13).asDiagonal().toDenseMatrix(), Vec3::Zero()};
  EXPECT_THROW(separatingAxis(f, thin, f, {}), std::invalid_argument);
}

}  // namespace
}  // namespace corridor
