// Distances of primitives far from the origin, at gaps down to the rounding of their coordinates:
// the error is within the bound of PROMISES.md, promise 1. (Within 2^-44 of the largest coordinate,
// contact may be reported instead.)
#include <algorithm>
#include <iostream>
#include <random>

#include <gtest/gtest.h>

#include "collision/convex/convex_contact.h"
#include "collision/core/rounding.h"
#include "collision/world/body_queries.h"
#include "tests/collision/convex/long_double_sets.h"
#include "tests/collision/convex/touching_pairs.h"
#include "tests/support/support.h"

namespace corridor::test {
namespace {

/// Returns the body of a feature. With `twice`, the shape occurs a second time, moved by `shift` in
/// its own frame.
Body bodyOfFeature(const ShapeFeature& f, bool twice, const Vec3& shift) {
  if (f.isTriangle) {
    const auto& p = f.part.points;
    return Body("triangle", TriangleMesh{{p[0], p[1], p[2]}, {{0, 1, 2}}});
  }
  std::vector<ConvexPart> parts{f.part};
  if (twice) {
    for (Vec3& p : parts[0].points) p += shift;
    parts.push_back(f.part);
  }
  return Body("part", parts);
}

/// Returns a lower bound of the distance that is exact up to rounding if n is the right direction:
/// the gap along n, in long double.
long double gapAlong(const ShapeFeature& a, const Transform& X_WA, const ShapeFeature& b,
                     const Transform& X_WB, const Vec3& n) {
  const Vec3L unit = n.cast<long double>().normalized();
  return -highest(b.part, X_WB, -unit) - highest(a.part, X_WA, unit);
}
Vec3L imageOf(const Transform& X, const Vec3& p) {
  return X.m.cast<long double>() * p.cast<long double>() + X.t.cast<long double>();
}

TEST(FarDistance, IsAsAccurateAsPromised) {
  Touching make(testSeed(5107));
  const TreeKind kinds[] = {TreeKind::obb4, TreeKind::obbBinary, TreeKind::aabb, TreeKind::sphere,
                            TreeKind::kdop18};
  int apart = 0, denied = 0;  // `denied`: volumes prove apart what the primitives' test cannot
  const int count = casesOf(15'000, 200'000);
  for (int n = 0; n < count; ++n) {
    // Flat faces in three of four cases: volumes separate them at smaller gaps than the primitives'
    // test does.
    const bool faces = make.pick(4) > 0;
    const auto feature = [&](Shape shape) {
      for (;;) {
        const ShapeFeature f = make.feature(shape);
        const bool isFlat = f.m.cwiseAbs().maxCoeff() == 1;
        if (isFlat || !faces || (shape != Shape::box && shape != Shape::cylinder)) return f;
      }
    };
    const ShapeFeature a = feature(kShapes[n % 6]), b = feature(kShapes[n / 6 % 6]);
    if (a.isTriangle && b.isTriangle) continue;
    // Half of the shapes have axes along the world's, so that boxes along the axes can separate.
    const Vec3 normal = make.pick(2) ? Vec3(Vec3::Unit(make.pick(3))) : make.vector().normalized();
    const Vec3 x = std::pow(10.0, make.real(2, 6)) * make.vector();
    const Transform X_WA = make.pose(a, x, normal);
    Transform X_WB = make.pose(b, x, -normal);
    const double gap = x.norm() * std::exp2(make.real(-50, -46));
    X_WB.t = (X_WB.t.cast<long double>() + normal.cast<long double>() * gap).cast<double>();
    const bool twice = make.pick(3) == 0 && !b.isTriangle;
    const Vec3 shift = X_WB.m.transpose() * normal * (gap * make.real(1, 4));
    const Body bodyA = bodyOfFeature(a, false, Vec3::Zero()),
               bodyB = bodyOfFeature(b, twice, shift);
    const Posed<Body> posedA(bodyA, X_WA), posedB(bodyB, X_WB);
    // The distance of the two features is an upper bound, and the gap along the normal a lower one.
    const long double upper = (imageOf(X_WB, b.x) - imageOf(X_WA, a.x)).norm(),
                      lower = gapAlong(a, X_WA, b, X_WB, normal);
    const double size = std::max(largestCoordinate(a.part, X_WA), largestCoordinate(b.part, X_WB));
    QueryContext context;
    const TreeKind trees = kinds[n % std::size(kinds)];
    const double d = distance(posedA, posedB, {}, context, trees).distance;
    const bool touches = interference(posedA, posedB, context, trees).has_value();
    ASSERT_EQ(d == 0, touches) << "case " << n;
    if (touches) {
      EXPECT_LE(lower, 0x1p-44L * size) << "case " << n;
      continue;
    }
    ++apart;
    denied += convexSetsTouch({a.part, X_WA}, {b.part, X_WB});
    const long double allowed = 1e-12L * d + 4 * kUnit * size;
    EXPECT_LE(d, upper + allowed) << "case " << n << ", gap " << gap;
    EXPECT_GE(d, lower - allowed) << "case " << n << ", gap " << gap;
  }
  std::cout << apart << " apart, of which " << denied << " are proved apart by volumes only\n";
  EXPECT_GT(apart, count / 8);
  EXPECT_GE(denied, count / 5'000);
}

}  // namespace
}  // namespace corridor::test
