#include "collision/convex/quick_contact.h"

#include <algorithm>
#include <array>
#include <iostream>
#include <numbers>

#include <gtest/gtest.h>

#include "collision/convex/convex_contact.h"
#include "tests/collision/convex/touching_pairs.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::Shape;
using test::ShapeFeature;
using test::Touching;

/// Returns the shape enlarged by a power of two, which rounds nothing.
ShapeFeature scaled(ShapeFeature f, double scale) {
  for (Vec3& p : f.part.points) p *= scale;
  f.part.radius *= scale;
  f.x *= scale;
  return f;
}

/// Pairs of shapes of any size, near the origin or far away, whose gap or depth is known by
/// construction and exceeds 2^-44 of the largest coordinate. If the quick step decides, its verdict
/// must be the known one. A query with a cache skips the quick step, and must have the same verdict
/// as a query without a cache.
TEST(QuickContact, AgreesWithTheConstructionAndTheFullSearch) {
  Touching make(test::testSeed(31));
  int decided = 0, cases = 0, wrong = 0, different = 0;
  for (const Shape sa : test::kShapes)
    for (const Shape sb : test::kShapes)
      for (int n = 0; n < 250; ++n) {
        const double scale = std::ldexp(1.0, n % 3 == 0 ? make.pick(60) - 30 : 0);
        const ShapeFeature a = scaled(make.feature(sa), scale), b = scaled(make.feature(sb), scale);
        const Vec3 normal = n % 5 == 0 ? Vec3(Vec3::Unit(n / 5 % 3)) : make.vector().normalized();
        const Vec3 x = make.vector() * (scale * (n % 4 == 0 ? 1e6 : 1));
        const Transform X_WA = make.pose(a, x, normal), touching = make.pose(b, x, -normal);
        const double size = std::max(test::largestCoordinate(a.set(), X_WA),
                                     test::largestCoordinate(b.set(), touching));
        for (const double factor : {0.3, 0x1p-10, 0x1p-25, 0x1p-36, 0x1p-40, 0x1.2p-44})
          for (const int sign : {-1, 1}) {
            const double gap = sign * factor * size;
            if (gap < -1e-7 * 0.4 * scale) continue;  // the least thickness limits the depth
            Transform X_WB = touching;
            X_WB.t =
                (touching.t.cast<long double>() + normal.cast<long double>() * gap).cast<double>();
            const PosedSet setA(a.set(), X_WA), setB(b.set(), X_WB);
            const auto quick = quickContact(setA, setB);
            ConvexCache cache;
            const bool full = convexSetsTouch(setA, setB, &cache);
            ++cases;
            decided += quick.has_value();
            // Two triangles with a negative gap may have passed through each other completely, so
            // their verdict is not known.
            const bool flat = a.isTriangle && b.isTriangle;
            wrong += !flat && quick && *quick != (gap < 0);
            different += full != convexSetsTouch(setA, setB);
          }
      }
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(different, 0);
  EXPECT_GT(decided, cases / 2);
  std::cout << cases << " cases, decided by the quick step: " << decided << "\n";
}

/// At gaps of a millimetre, the quick step decides nearly every pair. If it stopped doing so,
/// queries would be right but slow.
TEST(QuickContact, DecidesAllButContactsOfAThousandth) {
  Touching make(test::testSeed(32));
  int decided = 0, cases = 0;
  for (const Shape sa : test::kShapes)
    for (const Shape sb : test::kShapes)
      for (int n = 0; n < 200; ++n) {
        const ShapeFeature a = make.feature(sa), b = make.feature(sb);
        const Vec3 normal = make.vector().normalized(), x = make.vector();
        const Transform X_WA = make.pose(a, x, normal);
        Transform X_WB = make.pose(b, x, -normal);
        X_WB.t += 1e-3 * normal;
        ++cases;
        decided += quickContact({a.set(), X_WA}, {b.set(), X_WB}).has_value();
      }
  EXPECT_GT(decided, 0.95 * cases) << cases;
  std::cout << decided << " of " << cases << "\n";
}

/// A query with a cache skips the quick step. A cache must never change a verdict, not even under
/// maps that scale, mirror or flatten. If a map scales by a factor far from 1, `size` is far above
/// the coordinates.
TEST(QuickContact, AgreesWithTheFullSearchUnderMapsThatAreNotRigid) {
  Touching make(test::testSeed(34));
  int different = 0, contacts = 0, cases = 0;
  for (const Shape sa : test::kShapes)
    for (const Shape sb : test::kShapes)
      for (int n = 0; n < 200; ++n) {
        const double f = std::ldexp(1.0, (n % 2 ? 1 : -1) * std::array{1, 10, 40, 60}[n / 2 % 4]);
        const ShapeFeature a = make.feature(sa), b = make.feature(sb);
        const Vec3 normal = make.vector().normalized(), x = make.vector();
        Transform X_WA = make.pose(a, x, normal), X_WB = make.pose(b, x, -normal);
        X_WB.t += normal * std::ldexp(n % 5 == 0 ? -0.1 : 1.0, -make.pick(48));
        for (Transform* X : {&X_WA, &X_WB}) X->m *= f, X->t *= f;
        if (n % 3 == 0) X_WA.m.col(n / 3 % 3) *= n % 2 ? -1 : 0x1p-200;
        const PosedSet setA(a.set(), X_WA), setB(b.set(), X_WB);
        ConvexCache cache;
        const bool full = convexSetsTouch(setA, setB, &cache);
        ++cases;
        contacts += full;
        different += full != convexSetsTouch(setA, setB);
      }
  EXPECT_EQ(different, 0);
  EXPECT_GT(contacts, cases / 50);
  EXPECT_LT(contacts, cases * 9 / 10);
  // Two triangles, 2^-41 of the largest image coordinate apart.
  const Transform larger{1000 * Mat3::Identity(), Vec3::Zero()};
  const Triangle low{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  Triangle high = low;
  for (Vec3& p : high) p.z() = 3.8e-13;
  const ConvexSet lowSet(low), highSet(high);
  EXPECT_FALSE(convexSetsTouch({lowSet, larger}, {highSet, larger}));
}

/// If the plate is very thin, the square of its thickness underflows. Then a vector of this length,
/// across the plate, cannot be normalised.
TEST(QuickContact, PlatesOfAnyThicknessAreNotMissed) {
  const ConvexPart cube = placed(Box{{1, 1, 1}}, {});
  const Transform turned{Eigen::AngleAxisd(std::numbers::pi / 4, Vec3::UnitZ()).matrix(),
                         Vec3(0.7, 0, 0)};
  for (int k = 0; k > -1070; --k) {
    const double thin = std::ldexp(0.9, k);
    EXPECT_TRUE(convexSetsTouch({placed(Box{{thin, 0.2, 0.2}}, {}), {}}, {cube, turned})) << k;
    const Transform flat{Vec3(thin, 1, 1).asDiagonal().toDenseMatrix(), Vec3::Zero()};
    EXPECT_TRUE(convexSetsTouch({placed(Box{{1, 0.2, 0.2}}, {}), flat}, {cube, turned})) << k;
  }
}

using Int = std::int64_t;
using IntVec = Eigen::Matrix<Int, 3, 1>;
using IntMat = Eigen::Matrix<Int, 3, 3>;

/// Returns 25 times a rotation, which is a matrix of integers. The rotation is a product of two
/// rotations about coordinate axes, each by an angle of the right triangle (3, 4, 5) or by a
/// quarter turn.
IntMat turned(Touching& make) {
  const auto about = [&](int axis) {
    constexpr Int kSides[][2] = {{5, 0}, {3, 4}, {4, 3}, {0, 5}, {-3, 4}, {-5, 0}};
    const auto [c, s] = kSides[make.pick(6)];
    IntMat r = IntMat::Zero();
    const int i = (axis + 1) % 3, j = (axis + 2) % 3;
    r(axis, axis) = 5;
    r(i, i) = r(j, j) = c;
    r(i, j) = -s;
    r(j, i) = s;
    return r;
  };
  return about(make.pick(3)) * about(make.pick(3));
}

/// Compares boxes with integer corners under integer maps with the separating-axis theorem in
/// integers. Many pairs touch exactly. The maps are rotations times 25, and every fourth pair has
/// boxes whose edges are parallel. Edge lengths differ by a factor of up to 1000, so that thin
/// boxes occur.
TEST(QuickContact, BoxesAgainstIntegers) {
  Touching make(test::testSeed(33));
  int touching = 0, apart = 0, exactly = 0, decided = 0;
  for (int n = 0; n < 10'000; ++n) {
    IntVec half[2], center[2];
    IntMat turn[2];
    ConvexPart part[2];
    Transform X[2];
    for (int s = 0; s < 2; ++s) {
      const Int wide = make.pick(5) == 0 ? 1000 : 8;
      for (int k = 0; k < 3; ++k) half[s][k] = 1 + make.pick(make.pick(3) == 0 ? int(wide) : 4);
      turn[s] = s == 1 && n % 4 == 0 ? turn[0] : turned(make);
      for (int k = 0; k < 3; ++k) center[s][k] = s * (make.pick(2 * 25 * 9) - 25 * 9);
      part[s] = placed(Box{2.0 * half[s].cast<double>()}, {});
      X[s] = {turn[s].cast<double>(), center[s].cast<double>()};
    }
    std::vector<IntVec> axes;
    for (int i = 0; i < 3; ++i) {
      axes.push_back(turn[0].col(i));
      axes.push_back(turn[1].col(i));
      for (int j = 0; j < 3; ++j) axes.push_back(turn[0].col(i).cross(turn[1].col(j)));
    }
    bool separate = false, touch = false;
    for (const IntVec& axis : axes) {
      if (axis.isZero()) continue;
      Int gap = std::abs(axis.dot(center[1] - center[0]));
      for (int s = 0; s < 2; ++s)
        for (int k = 0; k < 3; ++k) gap -= half[s][k] * std::abs(axis.dot(turn[s].col(k)));
      separate = separate || gap > 0;
      touch = touch || gap == 0;
    }
    const auto quick = quickContact({part[0], X[0]}, {part[1], X[1]});
    if (quick) {
      EXPECT_EQ(*quick, !separate) << n;
    }
    EXPECT_EQ(convexSetsTouch({part[0], X[0]}, {part[1], X[1]}), !separate) << n;
    decided += quick.has_value();
    (separate ? apart : touching)++;
    exactly += !separate && touch;
  }
  EXPECT_GT(touching, 1'000);
  EXPECT_GT(apart, 1'000);
  EXPECT_GT(exactly, 10);
  EXPECT_GT(decided, 9'000);
  std::cout << exactly << " touch exactly, " << decided << " decided by the quick step\n";
}

/// Eight points that are nearly the corners of a box. The box test may treat them as a box only if
/// they are a box up to rounding; otherwise it must treat them as a hull. Here one corner sticks
/// out, and decides whether there is contact.
TEST(QuickContact, EightPointsThatAreNoBox) {
  Touching make(test::testSeed(34));
  const ConvexPart wall = placed(Box{Vec3(1, 4, 4)}, {Mat3::Identity(), Vec3(1.5, 0, 0)});
  for (int n = 0; n < 2'000; ++n) {
    ConvexPart part = placed(Box{Vec3(1, 1, 1)}, {});
    const double out = std::pow(10.0, -1 - n % 12);
    const std::size_t corner = 1 + 2 * std::size_t(make.pick(4));  // x = 0.5
    part.points[corner][0] += out;
    for (const double gap : {-0.3 * out, 0.3 * out}) {
      const Transform X{Mat3::Identity(), Vec3(0.5 - out - gap, 0, 0)};
      EXPECT_EQ(convexSetsTouch({part, X}, {wall, {}}), gap < 0) << n << " " << out;
    }
  }
}

}  // namespace
}  // namespace corridor
