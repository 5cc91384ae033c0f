#include "collision/convex/convex_contact.h"

#include <algorithm>
#include <iostream>

#include <gtest/gtest.h>

#include "tests/collision/convex/long_double_sets.h"
#include "tests/collision/convex/touching_pairs.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::Shape;
using test::ShapeFeature;
using test::Touching;

/// Tests contact for all pairs of shapes and features, at gaps and depths that are fractions of the
/// largest coordinate. The verdict is known by construction. It must be right unless the gap is so
/// small that contact may be reported for separate sets (the band); it must never be a false
/// separation.
TEST(ConvexContact, RightOutsideTheBandNeverFalselyFree) {
  Touching make(test::testSeed(21));
  const double factors[] = {0x1p-10, 0x1p-30, 0x1p-40, 0x1p-43, 0x1.1p-44};
  int wrong = 0, falseFree = 0, cases = 0;
  const int count = test::casesOf(170, 600);  // per pair of shapes
  int moreDigits = 0;
  for (const Shape sa : test::kShapes)
    for (const Shape sb : test::kShapes) {
      // Pairs of triangles are left out: they have an exact predicate.
      if (sa == Shape::triangle && sb == Shape::triangle) continue;
      for (int n = 0; n < count; ++n) {
        const ShapeFeature a = make.feature(sa), b = make.feature(sb);
        const Vec3 normal = n % 5 == 0 ? Vec3(Vec3::Unit(n / 5 % 3)) : make.vector().normalized();
        const Vec3 x = make.vector() * (n % 4 == 0 ? 1e6 : 1);
        const Transform X_WA = make.pose(a, x, normal), touching = make.pose(b, x, -normal);
        const double size = std::max(test::largestCoordinate(a.set(), X_WA),
                                     test::largestCoordinate(b.set(), touching));
        // The least thickness of the shapes limits the depth.
        for (const double factor : factors)
          for (const int sign : {-1, 1}) {
            const double gap = sign * factor * size;
            if (gap < -1e-7 * 0.4) continue;
            Transform X_WB = touching;
            X_WB.t =
                (touching.t.cast<long double>() + normal.cast<long double>() * gap).cast<double>();
            const PosedSet setA(a.set(), X_WA), setB(b.set(), X_WB);
            const PredicateResult touch = convexSetsTouch(setA, setB);
            moreDigits += touch.exact;
            EXPECT_EQ(touch, convexSetsTouch(setB, setA));
            if (touch != (gap < 0)) {
              ++wrong;
              if (wrong < 10)
                std::cout << "shapes " << int(sa) << " " << int(sb) << " case " << n << " factor "
                          << factor << " sign " << sign << " size " << size << "\n";
            }
            ++cases;
          }
        // At a depth within the band the sets must touch: 2^-48·size exceeds the rounding of the
        // poses, 2^-53·size each.
        Transform X_WB = touching;
        X_WB.t -= normal * (0x1p-48 * size);
        falseFree += !convexSetsTouch({a.set(), X_WA}, {b.set(), X_WB});
      }
    }
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(falseFree, 0);
  EXPECT_GT(cases, 166 * count);
  std::cout << cases << " cases; decided with more digits than double: " << moreDigits << "\n";
}

using test::Vec3L;

/// Returns the distance of the point q from a solid, both in the solid's frame, by closed forms; 0
/// if q is inside.
long double distanceFrom(const Primitive& primitive, const Vec3L& q) {
  const long double radial = std::hypot(q[0], q[1]), z = std::abs(q[2]);
  const auto beyond = [](long double x) { return std::max(0.0L, x); };
  if (const auto* box = std::get_if<Box>(&primitive)) {
    Vec3L out;
    for (int i = 0; i < 3; ++i) out[i] = beyond(std::abs(q[i]) - 0.5L * box->size[i]);
    return out.norm();
  }
  if (const auto* sphere = std::get_if<Sphere>(&primitive))
    return beyond(q.norm() - sphere->radius);
  if (const auto* c = std::get_if<Capsule>(&primitive))
    return beyond(std::hypot(radial, beyond(z - 0.5L * c->length)) - c->radius);
  const auto& c = std::get<Cylinder>(primitive);
  return std::hypot(beyond(radial - c.radius), beyond(z - 0.5L * c.length));
}

/// Tests contact of spheres with all primitives against closed forms. A third of the spheres are
/// nearly points, so spheres inside of every primitive are tested, too.
TEST(ConvexContact, SpheresAgainstClosedForms) {
  Touching make(test::testSeed(22));
  int touching = 0, apart = 0;
  for (int n = 0; n < 20'000; ++n) {
    Primitive p;
    switch (n % 4) {
      case 0:
        p = Box{Vec3(make.extent(), make.extent(), make.extent())};
        break;
      case 1:
        p = Sphere{make.extent()};
        break;
      case 2:
        p = Capsule{make.extent(), make.extent()};
        break;
      default:
        p = Cylinder{make.extent(), make.extent()};
    }
    Transform X;
    X.m = Eigen::Quaterniond(make.real(), make.real(), make.real(), make.real())
              .normalized()
              .toRotationMatrix();
    X.t = make.vector();
    const double radius = n % 3 == 0 ? 1e-9 : make.extent();
    const Vec3 center = X.t + make.vector() * make.real(0, 1);
    const Vec3L q = X.m.cast<long double>().transpose() *
                    (center.cast<long double>() - X.t.cast<long double>());
    const long double clearance = distanceFrom(p, q) - radius;
    if (std::abs(clearance) < 1e-14L) continue;
    const ConvexPart part = placed(p, {}), ball{{center}, radius, false};
    EXPECT_EQ(convexSetsTouch({part, X}, {ball, {}}), clearance < 0)
        << nameOf(p) << " case " << n << " clearance " << clearance;
    (clearance < 0 ? touching : apart)++;
  }
  EXPECT_GT(touching, 2'000);
  EXPECT_GT(apart, 2'000);
}

/// Compares polytopes of integer corners with the separating-axis theorem in integers. The axes are
/// all normals of faces and all cross products of edges, where any two corners count as an edge.
/// Many pairs touch exactly.
TEST(ConvexContact, PolytopesAgainstIntegers) {
  using Int = std::int64_t;
  using IntVec = Eigen::Matrix<Int, 3, 1>;
  Touching make(test::testSeed(23));
  int touching = 0, apart = 0, exactly = 0;
  for (int n = 0; n < 4'000; ++n) {
    std::vector<IntVec> corners[2];
    ConvexPart parts[2];
    const int range = 1 + n % 6;
    for (int s = 0; s < 2; ++s)
      for (int i = 0; i < 2 + n % 4; ++i) {
        const IntVec p(make.pick(2 * range) + s * make.pick(2 * range), make.pick(2 * range),
                       make.pick(2 * range));
        corners[s].push_back(p);
        parts[s].points.push_back(p.cast<double>());
      }
    std::vector<IntVec> edges[2], axes;
    for (int s = 0; s < 2; ++s)
      for (const IntVec& p : corners[s])
        for (const IntVec& q : corners[s]) edges[s].push_back(q - p);
    for (const IntVec& e : edges[0])
      for (const IntVec& f : edges[1]) axes.push_back(e.cross(f));
    for (int s = 0; s < 2; ++s)
      for (const IntVec& e : edges[s])
        for (const IntVec& f : edges[s]) axes.push_back(e.cross(f));
    for (int s = 0; s < 2; ++s)
      for (const IntVec& e : edges[s]) axes.push_back(e.cross(corners[1][0] - corners[0][0]));
    // If both sets lie in one plane, all these axes are parallel to its normal. Therefore the test
    // also uses the normals of the edges within this plane, and, for sets on a line, the direction
    // of the line.
    const auto normal =
        std::find_if(axes.begin(), axes.end(), [](const IntVec& axis) { return !axis.isZero(); });
    if (normal != axes.end()) {
      const IntVec plane = *normal;
      for (int s = 0; s < 2; ++s)
        for (const IntVec& e : edges[s]) axes.push_back(plane.cross(e));
    }
    for (int s = 0; s < 2; ++s) axes.insert(axes.end(), edges[s].begin(), edges[s].end());
    for (const IntVec& p : corners[0])
      for (const IntVec& q : corners[1]) axes.push_back(q - p);
    bool separate = false, touch = false;
    for (const IntVec& axis : axes) {
      if (axis.isZero()) continue;
      Int low[2], high[2];
      for (int s = 0; s < 2; ++s) {
        low[s] = high[s] = axis.dot(corners[s][0]);
        for (const IntVec& p : corners[s])
          low[s] = std::min(low[s], axis.dot(p)), high[s] = std::max(high[s], axis.dot(p));
      }
      separate = separate || high[0] < low[1] || high[1] < low[0];
      touch = touch || high[0] == low[1] || high[1] == low[0];
    }
    EXPECT_EQ(convexSetsTouch({parts[0], {}}, {parts[1], {}}), !separate) << n;
    (separate ? apart : touching)++;
    exactly += !separate && touch;
  }
  EXPECT_GT(touching, 500);
  EXPECT_GT(apart, 500);
  EXPECT_GT(exactly, 100);
}

/// A corner touches a face exactly, in integers. Both sets have the same map, so they still touch.
/// With an error bound that is too small, the query would report the sets as apart.
TEST(ConvexContact, TouchingSetsTouchUnderACommonMap) {
  Touching make(test::testSeed(26));
  const auto integers = [&] {
    return Vec3(make.pick(64) - 32, make.pick(64) - 32, make.pick(64) - 32);
  };
  int falseFree = 0;
  for (int n = 0; n < 50'000 / test::kSlowdown; ++n) {
    const Vec3 p = integers(), u = integers(), v = integers(), w = integers();
    const ConvexPart a{{p, p + 4 * u, p + 4 * v, p - w}, 0, false},
        b{{p + u + v, p + u + v + w}, 0, false};
    const Transform X{make.turning(Vec3::UnitX(), make.vector().normalized()), 100 * make.vector()};
    falseFree += !convexSetsTouch({a, X}, {b, X});
    falseFree += !convexSetsTouch({b, X}, {a, X});
  }
  EXPECT_EQ(falseFree, 0);
}

/// Under a map that is not rigid, the query tests the image of the set: a sphere becomes an
/// ellipsoid. Here a sphere and a cylinder are stretched along z, above a plate.
TEST(ConvexContact, AnyAffineMap) {
  const ConvexPart plate = placed(Box{Vec3(4, 4, 1)}, {});
  Transform X;
  X.m = Vec3(1, 1, 3).asDiagonal();
  for (const Primitive& p : {Primitive(Sphere{1}), Primitive(Cylinder{1, 2})}) {
    const ConvexPart part = placed(p, {});
    X.t = Vec3(0, 0, 3.5 + 1e-9);
    EXPECT_FALSE(convexSetsTouch({plate, {}}, {part, X}));
    X.t = Vec3(0, 0, 3.5 - 1e-9);
    EXPECT_TRUE(convexSetsTouch({plate, {}}, {part, X}));
  }
}

TEST(ConvexContact, OverflowAndTinySetsAreNeverFalselyFree) {
  for (const double size : {1e-320, 1e-200, 1e160, 1e300}) {
    const ConvexPart a{{Vec3(0, 0, 0), Vec3(size, 0, 0), Vec3(0, size, 0)}, 0, false};
    const ConvexPart b{{Vec3(size / 4, size / 4, -size), Vec3(size / 4, size / 4, size)}, 0, false};
    EXPECT_TRUE(convexSetsTouch({a, {}}, {b, {}})) << size;
  }
}

}  // namespace
}  // namespace corridor
