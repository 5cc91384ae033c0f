#include "collision/convex/convex_distance.h"

#include <iomanip>
#include <iostream>

#include <gtest/gtest.h>

#include "collision/convex/convex_contact.h"
#include "collision/core/rounding.h"
#include "tests/collision/convex/long_double_sets.h"
#include "tests/collision/convex/touching_pairs.h"
#include "tests/support/reference_distance.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::Shape;
using test::ShapeFeature;
using test::Touching;
using test::Vec3L;

const char* const kNames[] = {"box", "sphere", "capsule", "cylinder", "convex", "triangle"};

struct PosedPart {
  ConvexPart part;
  Transform X;
  PosedSet set() const { return {part, X}; }
};

double sizeOf(const PosedPart& a, const PosedPart& b) {
  return std::max(test::largestCoordinate(a.part, a.X), test::largestCoordinate(b.part, b.X));
}

/// Returns the error bound that convex_distance.h guarantees for sets of this size at this
/// distance.
double allowedAt(double distance, double size) {
  return 1e-12 * distance + 4 * kUnit * size;
}

/// Checks the properties that do not depend on the true distance:
/// * the witness points are on the sets, and `distance` apart;
/// * `distance` and `lower` differ by no more than guaranteed, and the range contains the distance;
/// * the distance is 0 if and only if the sets touch;
/// * swapping the sets gives the same distance.
///
/// Returns the distance, or a negative number if the sets touch.
double checked(const PosedPart& a, const PosedPart& b, const std::string& what) {
  const ConvexDistance d = convexDistance(a.set(), b.set()),
                       back = convexDistance(b.set(), a.set());
  const ConvexRange range = convexDistanceRange(a.set(), b.set(), HUGE_VAL, 0);
  const double size = sizeOf(a, b), allowed = allowedAt(d.distance, size);
  const bool touch = convexSetsTouch(a.set(), b.set());
  EXPECT_EQ(d.distance == 0, touch) << what;
  EXPECT_LE(d.lower, d.distance) << what;
  EXPECT_LE(range.lower, d.distance) << what;
  EXPECT_GE(range.upper, d.lower) << what;
  // At distances of at most 2^-44·size, contact may be reported for sets that are apart. A witness
  // point may then be as far from one set as the sets are apart.
  const double surface = (touch ? 0x1p-44 : 16 * kUnit) * size;
  EXPECT_LE(test::outside(a.part, a.X, d.p_WA),
            touch && a.part.points.size() > 3 ? HUGE_VAL : surface)
      << what;
  EXPECT_LE(test::outside(b.part, b.X, d.p_WB),
            touch && b.part.points.size() > 3 ? HUGE_VAL : surface)
      << what;
  EXPECT_LE(std::abs((d.p_WB - d.p_WA).norm() - d.distance), 4 * kUnit * (size + d.distance))
      << what;
  if (touch) {
    const ConvexPart point{{d.p_WA}, 0, false};
    EXPECT_EQ(d.p_WA, d.p_WB) << what;
    for (const PosedPart* side : {&a, &b})
      EXPECT_LE(convexDistance(side->set(), {point, {}}).distance, surface) << what;
    return -1;
  }
  EXPECT_LE(d.distance - d.lower, allowed) << what;
  EXPECT_LE(std::abs(back.distance - d.distance), 2 * allowed) << what;
  return d.distance;
}

/// The distance is right for all pairs of shapes and features, at gaps known by construction. Gaps
/// go from ten times the shapes' size to less than the rounding of their positions. Some shapes are
/// far from the origin, small, or large.
TEST(ConvexDistance, KnownGaps) {
  Touching make(test::testSeed(31));
  std::cout << std::setprecision(2);
  const int count = test::casesOf(240, 400);  // per pair of shapes
  for (const Shape sa : test::kShapes)
    for (const Shape sb : test::kShapes) {
      if (sb < sa) continue;
      double worst = 0;
      int apart = 0;
      for (int n = 0; n < count; ++n) {
        const ShapeFeature fa = make.feature(sa), fb = make.feature(sb);
        const Vec3 normal = n % 5 == 0 ? Vec3(Vec3::Unit(n / 5 % 3)) : make.vector().normalized();
        const Vec3 x = make.vector() * (n % 4 == 0 ? 1e3 : 1);
        const double scale = n % 7 == 0 ? 1e-6 : n % 7 == 1 ? 1e6 : 1;
        ShapeFeature ga = fa, gb = fb;
        for (ShapeFeature* f : {&ga, &gb}) {
          for (Vec3& p : f->part.points) p *= scale;
          f->part.radius *= scale;
          f->x *= scale;
        }
        PosedPart a{ga.part, make.pose(ga, scale * x, normal)},
            b{gb.part, make.pose(gb, scale * x, -normal)};
        const double gap = scale * std::pow(10.0, 1 - n % 16);
        b.X.t = (b.X.t.cast<long double>() + normal.cast<long double>() * gap).cast<double>();
        const std::string what =
            std::string(kNames[int(sa)]) + " " + kNames[int(sb)] + " case " + std::to_string(n);
        const double d = checked(a, b, what);
        if (d < 0) {
          EXPECT_LE(gap, 0x1p-44 * sizeOf(a, b)) << what;
          continue;
        }
        // The rounding of the constructed positions may double the error.
        const double allowed = allowedAt(gap, sizeOf(a, b)) + 4 * kUnit * sizeOf(a, b);
        EXPECT_LE(std::abs(d - gap), allowed) << what << " gap " << gap;
        worst = std::max(worst, std::abs(d - gap) / allowed);
        ++apart;
      }
      std::cout << kNames[int(sa)] << " " << kNames[int(sb)] << ": worst error " << worst
                << " of what is allowed, " << apart << " apart\n";
      EXPECT_GT(apart, count * 3 / 4);
    }
}

/// Random poses. The gap along `normal_W`, computed in long double, is a lower bound of the true
/// distance. The distance of the witness points is an upper bound. The reported distance must agree
/// with both.
TEST(ConvexDistance, RandomPosesAgainstASeparatingPlane) {
  Touching make(test::testSeed(32));
  int apart = 0, touching = 0;
  const int count = test::casesOf(6'000, 12'000);
  for (int n = 0; n < count; ++n) {
    const Shape sa = test::kShapes[n % 6], sb = test::kShapes[n / 6 % 6];
    const auto pose = [&] {
      Transform X;
      X.m = Eigen::Quaterniond(make.real(), make.real(), make.real(), make.real())
                .normalized()
                .toRotationMatrix();
      X.t = make.vector() * 1.5;
      return X;
    };
    const PosedPart a{make.feature(sa).part, pose()}, b{make.feature(sb).part, pose()};
    const std::string what =
        std::string(kNames[int(sa)]) + " " + kNames[int(sb)] + " case " + std::to_string(n);
    const double d = checked(a, b, what);
    if (d < 0) {
      ++touching;
      continue;
    }
    const ConvexDistance found = convexDistance(a.set(), b.set());
    const Vec3L normal = found.normal_W.cast<long double>();
    const long double gap =
        -test::highest(b.part, b.X, -normal) - test::highest(a.part, a.X, normal);
    const double size = sizeOf(a, b);
    EXPECT_GE(static_cast<double>(gap), found.lower - 4 * kUnit * size) << what;
    EXPECT_GE(static_cast<double>(gap), d - allowedAt(d, size) - 4 * kUnit * size) << what;
    ++apart;
    // A common rigid map does not change the distance.
    Transform X = pose();
    X.t *= 10;
    const PosedPart a2{a.part, X * a.X}, b2{b.part, X * b.X};
    const double moved = convexDistance(a2.set(), b2.set()).distance;
    EXPECT_LE(std::abs(moved - d), 8 * allowedAt(d, sizeOf(a2, b2))) << what;
  }
  EXPECT_GT(apart, count / 4);
  EXPECT_GT(touching, count / 24);
}

/// Compares distances of polytopes with brute force: all triangles that three corners of a form
/// against all that three corners of b form, in arithmetic with a hundred digits.
TEST(ConvexDistance, PolytopesAgainstAllTheirTriangles) {
  Touching make(test::testSeed(33));
  int apart = 0;
  for (int n = 0; n < 60 / test::kSlowdown + 1; ++n) {
    PosedPart a, b;
    for (int i = 0; i < 3 + n % 3; ++i) a.part.points.push_back(make.vector());
    for (int i = 0; i < 3 + n / 3 % 3; ++i) b.part.points.push_back(make.vector());
    if (n % 2) {  // b gets a face that is nearly parallel to a face of a
      for (int i = 0; i < 3; ++i)
        b.part.points[i] = a.part.points[i] + std::pow(10.0, -n % 13) * make.vector();
    }
    b.X.t = make.vector() * 1.5;
    if (convexSetsTouch(a.set(), b.set())) continue;
    ++apart;
    double truth = 1e300;
    const auto triples = [](const ConvexPart& part) {
      std::vector<Triangle> all;
      const auto& p = part.points;
      for (std::size_t i = 0; i < p.size(); ++i)
        for (std::size_t k = 0; k < i; ++k)
          for (std::size_t l = 0; l < k; ++l) all.push_back({p[i], p[k], p[l]});
      return all;
    };
    for (const Triangle& s : triples(a.part))
      for (const Triangle& t : triples(b.part))
        truth = std::min(truth, test::referenceDistance(s, a.X, t, b.X));
    const double d = static_cast<double>(truth);
    EXPECT_NEAR(checked(a, b, std::to_string(n)), d, allowedAt(d, sizeOf(a, b))) << n;
  }
  EXPECT_GT(apart, 20 / test::kSlowdown);
}

/// `lower` exceeds the exact distance by at most one unit in the last place. Some faces are so
/// nearly parallel that, in doubles, all their corners are at the same height along the normal.
TEST(ConvexDistance, LowerNeverExceedsTheExactDistance) {
  Touching make(test::testSeed(36));
  int exact = 0;
  for (int n = 0; n < 40 / test::kSlowdown + 1; ++n) {
    const Mat3 turn = make.turning(Vec3::UnitZ(), make.vector().normalized());
    PosedPart a, b;
    for (int i = 0; i < 4; ++i) {
      a.part.points.push_back(turn * Vec3(make.real(), make.real(), 0));
      b.part.points.push_back(turn * Vec3(make.real(), make.real(), 1e-3));
    }
    double truth = 1e300;
    const auto without = [](const ConvexPart& part, int k) {
      const auto& p = part.points;
      return Triangle{p[(k + 1) % 4], p[(k + 2) % 4], p[(k + 3) % 4]};
    };
    for (int i = 0; i < 4; ++i)
      for (int k = 0; k < 4; ++k)
        truth = std::min(truth,
                         test::referenceDistance(without(a.part, i), a.X, without(b.part, k), b.X));
    const ConvexDistance found = convexDistance(a.set(), b.set());
    EXPECT_LE(found.lower, static_cast<double>(truth) * (1 + 2 * kUnit)) << n;
    exact += found.exact;
  }
  EXPECT_GT(exact, 0);
}

ConvexPart placedAt(const Primitive& primitive, const Vec3& t, const Vec3& axis = Vec3::UnitX(),
                    double angle = 0) {
  Transform X;
  X.m = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
  X.t = t;
  return placed(primitive, X);
}

TEST(ConvexDistance, ClosedForms) {
  const double right = std::acos(0.0);
  const auto expect = [](const ConvexPart& a, const ConvexPart& b, double truth, const char* what) {
    const PosedPart pa{a, {}}, pb{b, {}};
    EXPECT_NEAR(checked(pa, pb, what), truth, allowedAt(truth, sizeOf(pa, pb))) << what;
  };
  const ConvexPart sphere = placedAt(Sphere{0.5}, {0, 0, 0});
  expect(sphere, placedAt(Sphere{0.25}, {3, 4, 0}), 4.25, "spheres");
  expect(sphere, placedAt(Capsule{0.25, 2}, {0.3, 2, 0.4}), std::hypot(0.3, 2) - 0.75,
         "sphere, capsule's side");
  expect(sphere, placedAt(Capsule{0.25, 2}, {0, 0, 3}), 1.25, "sphere, capsule's end");
  expect(sphere, placedAt(Box{{2, 2, 2}}, {3, 0, 0}), 1.5, "sphere, box's face");
  expect(sphere, placedAt(Box{{2, 2, 2}}, {3, 3, 3}), 2 * std::sqrt(3) - 0.5, "sphere, corner");
  expect(sphere, placedAt(Cylinder{1, 2}, {4, 0, 4}), std::sqrt(18) - 0.5, "sphere, rim");
  expect(placedAt(Capsule{0.1, 2}, {0, 0, 0}), placedAt(Capsule{0.2, 2}, {1, 0, 0.5}), 0.7,
         "parallel capsules");
  expect(placedAt(Capsule{0.1, 2}, {0, 0, 0}),
         placedAt(Capsule{0.2, 2}, {1, 0.3, 0.2}, Vec3::UnitX(), 1), 0.7, "crossed capsules");
  expect(placedAt(Box{{1, 1, 1}}, {0, 0, 0}), placedAt(Box{{1, 1, 1}}, {0.5, 0.5, 1.75}), 0.75,
         "boxes, faces");
  expect(placedAt(Box{{1, 1, 1}}, {0, 0, 0}), placedAt(Box{{1, 1, 1}}, {4, 5, 0.5}), 5,
         "boxes, edges");
  const ConvexPart cylinder = placedAt(Cylinder{0.5, 2}, {0, 0, 0});
  expect(cylinder, placedAt(Cylinder{0.25, 1}, {0.1, 0.1, 2}), 0.5, "cylinders, caps");
  expect(cylinder, placedAt(Cylinder{0.25, 1}, {2, 0, 0.5}), 1.25, "cylinders, parallel");
  expect(cylinder, placedAt(Cylinder{0.25, 1}, {2, 0, 3}), std::hypot(1.25, 1.5),
         "cylinders, rims");
  expect(cylinder, placedAt(Cylinder{0.25, 3}, {2, 0, 0.1}, Vec3::UnitX(), right), 1.25,
         "cylinders, crossed");
  expect(cylinder, placedAt(Cylinder{0.25, 3}, {2, 0, 0.1}, Vec3::UnitX(), 0.7), 1.25,
         "cylinders, askew");
  // A corner beside a rim; the corner and the axis lie in one plane.
  expect(cylinder, placedAt(Convex{{{1.5, 0, 2}, {2, 1, 3}, {2, -1, 3}}}, {0, 0, 0}), std::sqrt(2),
         "rim, corner");
}

TEST(ConvexDistance, FlatThinAndPointShapes) {
  const Vec3 o = Vec3::Zero();
  const ConvexPart point{{o}, 0, false}, zeroCapsule{{o, o}, 0.5, false},
      plate{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {-1, -1, 0}}, 0, false},
      needle{{{0, 0, -1}, {0, 0, 0.25}, {0, 0, 1}}, 0, false}, disc{{o, o}, 0.5, true},
      coin{{{0, 0, -1e-9}, {0, 0, 1e-9}}, 0.5, true};
  const auto expect = [](const ConvexPart& a, const ConvexPart& b, const Vec3& t, double truth) {
    const PosedPart pa{a, {}}, pb{b, {Mat3::Identity(), t}};
    EXPECT_NEAR(checked(pa, pb, ""), truth, allowedAt(truth, sizeOf(pa, pb)));
  };
  expect(point, point, {0, 3, 4}, 5);
  expect(point, zeroCapsule, {0, 3, 4}, 4.5);
  expect(plate, plate, {0.5, 0.5, 1e-3}, 1e-3);
  expect(plate, plate, {5, 5, 0}, std::sqrt(18));
  expect(plate, needle, {0, 0, 1.5}, 0.5);
  expect(needle, needle, {1e-6, 0, 0.5}, 1e-6);
  expect(plate, coin, {0.3, 0.4, 0.25}, 0.25 - 1e-9);
  // A cylinder without an axis counts as a sphere (`ConvexSet`).
  expect(plate, disc, {0, 0, 2}, 1.5);
  for (const ConvexPart* part : {&point, &zeroCapsule, &plate, &needle, &coin}) {
    const PosedPart p{*part, {}};
    EXPECT_LT(checked(p, p, "itself"), 0);
  }
}

/// Distances and verdicts both treat a sphere under a map that is not rigid as an ellipsoid. This
/// tilted ellipsoid, with half axes (2, 1, 0.1), is above a plate.
TEST(ConvexDistance, AnyAffineMap) {
  const ConvexPart plate = placed(Box{Vec3(20, 20, 1)}, {});
  const ConvexPart ball = placed(Sphere{1}, {});
  for (const double angle : {0.0, 0.3, 1.2}) {
    const Mat3 turn = Eigen::AngleAxisd(angle, Vec3::UnitY()).toRotationMatrix();
    Transform X;
    X.m = turn * Vec3(2, 1, 0.1).asDiagonal();
    const double half = (X.m.transpose() * Vec3::UnitZ()).norm();
    for (const double gap : {2.0, 1e-3, 1e-9}) {
      X.t = Vec3(0.1, 0.2, 0.5 + half + gap);
      const PosedSet a(plate, {}), b(ball, X);
      const ConvexDistance d = convexDistance(a, b);
      EXPECT_NEAR(d.distance, gap, allowedAt(gap, 4)) << angle;
      EXPECT_LE(d.distance - d.lower, allowedAt(gap, 4)) << angle;
      EXPECT_NEAR((d.p_WB - d.p_WA).norm(), gap, allowedAt(gap, 4));
      EXPECT_NEAR(d.p_WA[2], 0.5, 8 * kUnit);
      EXPECT_NEAR((X.m.inverse() * (d.p_WB - X.t)).norm(), 1, 1e-12) << angle;
      EXPECT_FALSE(convexSetsTouch(a, b));
      EXPECT_FALSE(convexSetsTouch(b, a));
      X.t[2] -= 2 * gap;
      if (gap > half) continue;
      EXPECT_TRUE(convexSetsTouch(a, {ball, X}));
      const ConvexDistance in = convexDistance(a, {ball, X});
      EXPECT_EQ(in.distance, 0);
      EXPECT_EQ(in.p_WA, in.p_WB);
      EXPECT_LE((X.m.inverse() * (in.p_WB - X.t)).norm(), 1 + 1e-10);
      EXPECT_LE(in.p_WA[2], 0.5 + 1e-10);
    }
  }
}

/// A singular map flattens a sphere, so its extent in one direction is 0. A division by this extent
/// would fail.
TEST(ConvexDistance, BallsFlattenedByTheirMap) {
  const ConvexPart plate = placed(Box{Vec3(20, 20, 1)}, {});
  for (const Primitive& p : {Primitive(Sphere{1}), Primitive(Capsule{1, 2})})
    for (const Mat3& m : {Mat3(Vec3(1, 1, 0).asDiagonal()), Mat3(Vec3(0, 0, 0).asDiagonal()),
                          Mat3(Vec3(1, 1, 1e-200).asDiagonal())}) {
      const ConvexPart part = placed(p, {});
      const PosedSet a(plate, {}), b(part, {m, Vec3(0.1, 0.2, 0.75)});
      const ConvexDistance d = convexDistance(a, b), back = convexDistance(b, a);
      EXPECT_NEAR(d.distance, 0.25, allowedAt(0.25, 2));
      EXPECT_NEAR(back.distance, 0.25, allowedAt(0.25, 2));
      EXPECT_NEAR((d.p_WB - d.p_WA).norm(), 0.25, 4 * kUnit);
      EXPECT_LE(convexDistanceRange(a, b, HUGE_VAL, 0).upper, 1.75);
    }
}

/// The error grows with the coordinates after the map, not with the coordinates before the map.
/// These maps take points at 10^12 m to points that are a few metres apart, or to one point. The
/// other set is a sheared sphere, for which `lower` is wrong if the error bound leaves out a term.
TEST(ConvexDistance, FarPointsUnderAMapThatShrinks) {
  ConvexPart ball = placed(Sphere{12.75}, {});
  Transform shear;
  shear.m(2, 0) = 12.125;
  const ConvexPart far{{Vec3(1e12, -2e12, 5e11), Vec3(-3e12, 0, 1e12), Vec3(0, 1e12, -1e12)}};
  for (const double scale : {1e-12, 1e-300, 0.0}) {
    const Transform X{scale * Mat3::Identity(), Vec3(1000, 0, 0)};
    const PosedSet a(ball, shear), b(far, X);
    const ConvexDistance d = convexDistance(a, b);
    EXPECT_GT(d.distance, 980);
    EXPECT_LE(d.distance - d.lower, allowedAt(d.distance, 1200)) << scale;
    EXPECT_LE(d.lower, d.distance);
  }
}

/// If the cores barely overlap, the four corners around the origin are nearly in one plane. Even
/// then the witness point must belong to both sets.
TEST(ConvexDistance, WitnessPointOfBarelyOverlappingSets) {
  Touching make(test::testSeed(35));
  int touching = 0;
  for (int n = 0; n < 4'000 / test::kSlowdown; ++n) {
    const ShapeFeature fa = make.feature(Shape::cylinder),
                       fb = make.feature(n % 2 ? Shape::cylinder : Shape::box);
    const Vec3 normal = make.vector().normalized();
    const PosedPart a{fa.part, make.pose(fa, Vec3::Zero(), normal)};
    PosedPart b{fb.part, make.pose(fb, Vec3::Zero(), -normal)};
    b.X.t -= normal * std::pow(10.0, -8 - n % 5);
    const ConvexDistance d = convexDistance(a.set(), b.set());
    if (d.distance > 0) continue;
    ++touching;
    EXPECT_EQ(d.p_WA, d.p_WB);
    const ConvexPart point{{d.p_WA}, 0, false};
    for (const PosedPart& side : {a, b})
      EXPECT_LE(convexDistance(side.set(), {point, {}}).distance, 0x1p-30 * sizeOf(a, b)) << n;
  }
  EXPECT_GT(touching, 3'000 / test::kSlowdown);
}

TEST(ConvexDistance, AsCloseAsRequested) {
  Touching make(test::testSeed(34));
  for (int n = 0; n < 2'000 / test::kSlowdown; ++n) {
    const ShapeFeature fa = make.feature(Shape::cylinder), fb = make.feature(test::kShapes[n % 6]);
    const Vec3 normal = make.vector().normalized();
    const PosedPart a{fa.part, make.pose(fa, Vec3::Zero(), normal)};
    PosedPart b{fb.part, make.pose(fb, Vec3::Zero(), -normal)};
    const double gap = std::pow(10.0, -n % 5);
    b.X.t += normal * gap;
    const ConvexDistance exact = convexDistance(a.set(), b.set()),
                         d = convexDistance(a.set(), b.set(), 0.01, 1e-4);
    const double allowed = 0.01 * gap + 1e-4;
    EXPECT_GE(d.distance, exact.lower - 8 * kUnit * sizeOf(a, b)) << n;
    EXPECT_LE(d.distance, exact.distance + allowed) << n;
    EXPECT_LE(d.lower, exact.distance);
    EXPECT_LE(d.distance - d.lower, allowed) << n;
    // The search for the range may stop early, but only if its lower bound exceeds the requested
    // lower bound.
    EXPECT_GT(convexDistanceRange(a.set(), b.set(), gap / 2, 0).lower, gap / 2);
    EXPECT_LE(convexDistanceRange(a.set(), b.set(), HUGE_VAL, 2 * gap).upper, 2 * gap);
    EXPECT_FALSE(d.exact);
  }
}

TEST(ConvexDistance, OverflowAndTinySets) {
  for (const double size : {1e-320, 1e-200, 1e-100, 1e100, 1e160, 1e300}) {
    const ConvexPart a{{Vec3(0, 0, 0), Vec3(size, 0, 0), Vec3(0, size, 0)}, 0, false};
    const ConvexPart b{
        {Vec3(size / 4, size / 4, size), Vec3(size / 4, size / 4, 2 * size)}, 0, false};
    const ConvexDistance d = convexDistance({a, {}}, {b, {}});
    EXPECT_EQ(d.distance == 0, convexSetsTouch({a, {}}, {b, {}})) << size;
    if (size == 1e-100 || size == 1e100) {
      EXPECT_NEAR(d.distance / size, 1, 1e-12) << size;
    }
    const ConvexRange range = convexDistanceRange({a, {}}, {b, {}}, HUGE_VAL, 0);
    EXPECT_LE(range.lower, size * (1 + 1e-12));
    EXPECT_GE(range.upper, size * (1 - 1e-12));
  }
}

}  // namespace
}  // namespace corridor
