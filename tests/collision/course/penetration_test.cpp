#include "collision/course/penetration.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <stdexcept>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "collision/convex/convex_contact.h"
#include "collision/course/dobkin_kirkpatrick.h"
#include "tests/collision/convex/long_double_sets.h"
#include "tests/collision/convex/touching_pairs.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::Shape;
using test::Touching;

Transform randomPose(Touching& make, double far) {
  Eigen::Quaterniond q(make.real(), make.real(), make.real(), make.real());
  return {q.normalized().toRotationMatrix(), far * make.vector()};
}

Transform moved(Transform X, const Vec3& direction, double length) {
  X.t += length * direction;
  return X;
}

/// Returns the depth by the explicit Minkowski difference: the least signed distance of the origin
/// from the planes of the hull of all differences of a point of a and a point of b. It is negative
/// if the sets are apart.
double explicitDepth(const std::vector<Vec3>& a, const std::vector<Vec3>& b,
                     Vec3* along = nullptr) {
  std::vector<Vec3> all;
  for (const Vec3& p : a)
    for (const Vec3& q : b) all.push_back(p - q);
  const Polytope difference(all);
  long double least = std::numeric_limits<double>::infinity();
  for (const auto& face : difference.faces()) {
    using Vec = Eigen::Matrix<long double, 3, 1>;
    const Vec o = difference.vertices()[face[0]].cast<long double>();
    const Vec p = difference.vertices()[face[1]].cast<long double>() - o,
              q = difference.vertices()[face[2]].cast<long double>() - o;
    const Vec n = p.cross(q).normalized();
    if (!along) {
      least = std::min(least, n.dot(o));
    } else {
      const long double rate = n.dot(along->cast<long double>());
      if (rate > 1e-12L) least = std::min(least, n.dot(o) / rate);
    }
  }
  return static_cast<double>(least);
}

std::vector<Vec3> mapped(const Transform& X, std::span<const Vec3> points) {
  std::vector<Vec3> result;
  for (const Vec3& p : points) result.push_back(X * p);
  return result;
}

/// For random polytopes, the bounds of the depth must enclose the depth by the explicit Minkowski
/// difference, and must be close to each other.
TEST(Penetration, AgreesWithTheExplicitDifference) {
  Touching make(test::testSeed(31));
  const int cases = test::isStressRun() ? 3000 : 150 / test::kSlowdown + 5;
  double widest = 0;
  int overlapping = 0, rounds = 0;
  for (int n = 0; n < cases; ++n) {
    std::vector<Vec3> a, b;
    const int na = 4 + make.pick(40), nb = 4 + make.pick(40);
    const Vec3 shape = n % 3 ? Vec3(1, 1, 1) : Vec3(1, 0.01, 1e-4);
    for (int i = 0; i < na; ++i) a.push_back(make.vector().normalized().cwiseProduct(shape));
    for (int i = 0; i < nb; ++i) b.push_back(make.vector().normalized());
    const Transform X_WA = randomPose(make, 1), X_WB = randomPose(make, 0.8);
    const DobkinKirkpatrick fast{Polytope(a)};
    const Polytope climbing(b);
    const ConvexPart partA{a, 0, false}, partB{b, 0, false};
    const double truth = explicitDepth(mapped(X_WA, a), mapped(X_WB, b));
    for (const bool everyVertex : {true, false}) {
      const PosedSet setA = everyVertex ? PosedSet(partA, X_WA) : PosedSet(fast, X_WA);
      const PosedSet setB = everyVertex ? PosedSet(partB, X_WB) : PosedSet(climbing, X_WB);
      const Penetration found = penetration(setA, setB);
      ASSERT_LE(found.lower, std::max(0.0, truth) + 1e-14) << "case " << n;
      ASSERT_GE(found.upper, std::max(0.0, truth) - 1e-14) << "case " << n;
      if (truth < 1e-6) continue;
      ++overlapping;
      rounds += found.rounds;
      widest = std::max(widest, found.upper / found.lower - 1);
      EXPECT_LE((found.p_WA - found.p_WB - found.upper * found.direction_W).norm(),
                1e-7 * (1 + found.upper))
          << "case " << n;
      EXPECT_LE(test::outside(partA, X_WA, found.p_WA), 1e-12) << "case " << n;
      EXPECT_LE(test::outside(partB, X_WB, found.p_WB), 1e-12) << "case " << n;

      Vec3 direction = make.vector().normalized();
      const Penetration along = penetrationAlong(setA, setB, direction);
      direction = along.direction_W;
      const double expected = explicitDepth(mapped(X_WA, a), mapped(X_WB, b), &direction);
      EXPECT_LE(along.lower, expected * (1 + 1e-12) + 1e-14) << "case " << n;
      EXPECT_GE(along.upper, expected * (1 - 1e-12) - 1e-14) << "case " << n;
      EXPECT_LE(along.upper, along.lower * (1 + 1e-9) + 1e-13) << "case " << n;
      EXPECT_GE(along.upper * (1 + 1e-12), found.lower);
    }
  }
  std::cout << overlapping << " overlapping; widest bounds " << widest << "; mean rounds "
            << rounds / std::max(1, overlapping) << "\n";
  EXPECT_GT(overlapping, cases / 4);
  EXPECT_LE(widest, 1e-9);
}

/// Tests the bounds for all pairs of shapes. After a translation by `upper` along the reported
/// direction, b does not overlap a. After a translation by less than `lower` in any direction, b
/// still overlaps a.
TEST(Penetration, BoundsHoldForAllShapes) {
  Touching make(test::testSeed(32));
  double widest = 0;
  for (const Shape sa : test::kShapes)
    for (const Shape sb : test::kShapes)
      for (int n = 0; n < (test::isStressRun() ? 300 : 12 / test::kSlowdown + 1); ++n) {
        const ConvexPart a = make.feature(sa).part, b = make.feature(sb).part;
        const Transform X_WA = randomPose(make, n % 4 ? 0 : 1e3);
        Transform X_WB = randomPose(make, 0);
        X_WB.t = X_WA.t + 0.2 * make.vector();
        const PosedSet setA(a, X_WA), setB(b, X_WB);
        const Penetration found = penetration(setA, setB);
        const bool touch = convexSetsTouch(setA, setB);
        const std::string what = "shapes " + std::to_string(int(sa)) + " " +
                                 std::to_string(int(sb)) + " case " + std::to_string(n);
        ASSERT_LE(found.lower, found.upper) << what;
        if (!touch) {
          EXPECT_EQ(found.upper, 0) << what;
          continue;
        }
        const double size = 2 + X_WA.t.norm(), rounding = 0x1p-42 * size;
        EXPECT_FALSE(
            convexSetsTouch(setA, {b, moved(X_WB, found.direction_W, found.upper + rounding)}))
            << what;
        for (int k = 0; k < 20 && found.lower > rounding; ++k) {
          const Vec3 d = k == 0 ? found.direction_W : Vec3(make.vector().normalized());
          EXPECT_TRUE(convexSetsTouch(setA, {b, moved(X_WB, d, found.lower - rounding)})) << what;
        }
        const bool flat = sa == Shape::triangle || sb == Shape::triangle;
        if (found.upper > 1e-3 && !flat)
          widest = std::max(widest, (found.upper - rounding) / found.lower - 1);
        const Vec3 d = make.vector().normalized();
        const Penetration along = penetrationAlong(setA, setB, d);
        EXPECT_LE(along.lower, along.upper) << what;
        EXPECT_GE(along.upper, found.lower * (1 - 1e-12)) << what;
        if (along.upper < 100) {
          EXPECT_FALSE(convexSetsTouch(
              setA, {b, moved(X_WB, along.direction_W, along.upper + 100 * rounding)}))
              << what;
        }
        if (along.lower > 100 * rounding) {
          EXPECT_TRUE(convexSetsTouch(
              setA, {b, moved(X_WB, along.direction_W, along.lower - 100 * rounding)}))
              << what;
        }
      }
  std::cout << "widest bounds " << widest << "\n";
  EXPECT_LE(widest, 1e-4);
}

TEST(Penetration, ClosedForms) {
  const ConvexPart ball = placed(Sphere{0.5}, {}), capsule = placed(Capsule{0.25, 2}, {}),
                   box = placed(Box{{2, 4, 6}}, {}), rod = placed(Cylinder{0.5, 2}, {});
  const auto depth = [](const ConvexPart& a, const ConvexPart& b, const Vec3& t) {
    return penetration({a, {}}, {b, {Mat3::Identity(), t}});
  };
  EXPECT_NEAR(depth(ball, ball, {0.75, 0, 0}).upper, 0.25, 1e-13);
  EXPECT_NEAR(depth(ball, ball, {0.75, 0, 0}).direction_W.x(), 1, 1e-13);
  EXPECT_NEAR(depth(ball, capsule, {0.5, 0, 0.75}).upper, 0.25, 1e-13);
  EXPECT_NEAR(depth(ball, ball, {0, 0, 0}).lower, 1, 1e-12);  // any direction is right
  EXPECT_NEAR(depth(box, box, {1.5, 0, 1}).upper, 0.5, 1e-13);
  EXPECT_NEAR(depth(box, box, {0, 0, 0}).lower, 2, 1e-13);
  EXPECT_NEAR(depth(box, ball, {1.25, 0, 0}).upper, 0.25, 1e-13);
  EXPECT_NEAR(depth(box, ball, {0, 0, 0}).lower, 1.5, 1e-13);
  EXPECT_NEAR(depth(rod, rod, {0.75, 0, 0}).upper, 0.25, 3e-5);
  EXPECT_NEAR(depth(rod, rod, {0, 0, 1.75}).upper, 0.25, 1e-13);
  EXPECT_EQ(depth(box, box, {2.0000001, 0, 0}).upper, 0);
  const Penetration along =
      penetrationAlong({box, {}}, {box, {Mat3::Identity(), {1.5, 0, 1}}}, {0, 0, 3});
  EXPECT_NEAR(along.lower, 5, 1e-12);
  EXPECT_NEAR(along.upper, 5, 1e-12);
}

/// If the cores are flat and touch, the depth is the sum of the radii, and the reported points are
/// those that touch after the translation.
TEST(Penetration, WitnessesOfFlatCores) {
  const ConvexPart ball = placed(Sphere{0.5}, {}), capsule = placed(Capsule{0.25, 2}, {});
  const Transform across{Eigen::AngleAxisd(M_PI / 2, Vec3::UnitX()).toRotationMatrix(),
                         {0, 0, 0.3}};
  struct Case {
    ConvexPart a, b;
    Transform X_WB;
    double depth;
  };
  for (const Case& c :
       {Case{ball, ball, {}, 1}, Case{ball, capsule, {Mat3::Identity(), {0, 0, 0.4}}, 0.75},
        Case{capsule, capsule, across, 0.5}}) {
    const Penetration found = penetration({c.a, {}}, {c.b, c.X_WB});
    EXPECT_NEAR(found.lower, c.depth, 1e-12);
    EXPECT_NEAR(found.upper, c.depth, 1e-12);
    EXPECT_LE((found.p_WA - found.p_WB - found.upper * found.direction_W).norm(), 1e-12);
    EXPECT_LE(test::outside(c.a, {}, found.p_WA), 1e-12);
    EXPECT_LE(test::outside(c.b, c.X_WB, found.p_WB), 1e-12);
  }
}

/// Tests cores that are so small beside their spheres that the planes of the cores' faces cannot be
/// computed.
TEST(Penetration, TinyCores) {
  for (const double s : {1e-40, 1e-90, 1e-130}) {
    const ConvexPart c{
        {Vec3(s, s, s), Vec3(-s, -s, s), Vec3(s, -s, -s), Vec3(-s, s, -s)}, 0.5, false};
    const Penetration found = penetration({c, {}}, {c, {}});
    EXPECT_LE(found.lower, 1) << s;
    EXPECT_GE(found.lower, 1 - 1e-12) << s;
    EXPECT_GE(found.upper, 1) << s;
    EXPECT_LE(found.upper, 1 + 1e-12) << s;
    EXPECT_NEAR(found.direction_W.norm(), 1, 1e-15) << s;
  }
  for (const double s : {1e-130, 1e130}) {
    const ConvexPart box = placed(Box{{2 * s, 4 * s, 6 * s}}, {});
    const Penetration found = penetration({box, {}}, {box, {Mat3::Identity(), {1.5 * s, 0, 0}}});
    EXPECT_LE(found.lower, 0.5 * s);
    EXPECT_GE(found.upper, 0.5 * s);
    EXPECT_LE(found.upper - found.lower, 1e-12 * s);
  }
}

TEST(Penetration, DirectionsThatAreNoneAreRefused) {
  const ConvexPart ball = placed(Sphere{0.5}, {});
  const PosedSet set(ball, {});
  EXPECT_THROW(penetrationAlong(set, set, Vec3::Zero()), std::invalid_argument);
  EXPECT_THROW(penetrationAlong(set, set, {1, std::nan(""), 0}), std::invalid_argument);
}

}  // namespace
}  // namespace corridor
