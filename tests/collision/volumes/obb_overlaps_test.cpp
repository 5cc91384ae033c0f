// Compares the overlap tests of boxes with rationals: boxes that touch must never be separated, and
// boxes that are clearly apart must always be separated.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "collision/volumes/overlap_obb_obb_variants.h"
#include "tests/support/exact_volume.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using exact::cross;
using exact::dot;
using exact::Rational;
using exact::Row;

/// The exact answer for two boxes, computed in rationals. A box is the parallelepiped that its
/// doubles define. If two parallelepipeds are apart, a face normal or a common normal of two edges
/// separates them. A flat box is the limit of thicker boxes with the same axes, so none of the 15
/// axes may be left out.
struct Truth {
  bool touch = true;
  double widest = -HUGE_VAL;  ///< largest gap, metres
  double raw = -HUGE_VAL;     ///< largest gap times |L|, where L is the product of two unit axes

  Truth(const Obb& a, const Obb& b, const Transform& X) {
    std::array<Row, 3> u, v;
    for (int k = 0; k < 3; ++k) u[k] = exact::row(a.axes.col(k)), v[k] = mapped(X.m, b.axes.col(k));
    Row T = exact::minus(mapped(X.m, b.center), exact::row(a.center));
    for (int i = 0; i < 3; ++i) T[i] += Rational(X.t[i]);
    const auto look = [&](const Row& L) {
      Rational gap = abs(dot(T, L));
      for (int k = 0; k < 3; ++k)
        gap -= Rational(a.half[k]) * abs(dot(u[k], L)) + Rational(b.half[k]) * abs(dot(v[k], L));
      if (gap > 0) touch = false;
      const double length = std::sqrt(dot(L, L).convert_to<double>());
      if (length == 0) return;
      raw = std::max(raw, gap.convert_to<double>());
      widest = std::max(widest, gap.convert_to<double>() / length);
    };
    for (int i = 0; i < 3; ++i) {
      look(cross(u[i], u[(i + 1) % 3]));
      look(cross(v[i], v[(i + 1) % 3]));
      for (int j = 0; j < 3; ++j) look(cross(u[i], v[j]));
    }
  }

 private:
  static Row mapped(const Mat3& m, const Vec3& p) {
    Row q;
    for (int i = 0; i < 3; ++i)
      q[i] = Rational(m(i, 0)) * Rational(p[0]) + Rational(m(i, 1)) * Rational(p[1]) +
             Rational(m(i, 2)) * Rational(p[2]);
    return q;
  }
};

struct Boxes {
  Obb a, b;
  Transform X_AB;
  double scale = 1;  ///< metres: order of magnitude of sizes and coordinates
  /// The distance of the two supporting features, metres; negative if one is inside the other box.
  double step = 0;
};

/// Makes two boxes whose supporting features meet along one of the 15 axes. Then moves the boxes
/// apart or together by 10^-2 to 10^-17 of their size. Some pairs are parallel, nearly parallel,
/// flat, of very different sizes, far away, huge or tiny.
Boxes nearTouching(std::mt19937_64& random, int n) {
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const auto rotation = [&] {
    std::normal_distribution<double> normal;
    const double w = normal(random), x = normal(random), y = normal(random), z = normal(random);
    return Mat3(Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix());
  };
  Boxes boxes;
  for (Obb* box : {&boxes.a, &boxes.b}) {
    box->center = std::pow(10, uniform(-3, 2)) * Vec3(uniform(-1, 1), uniform(-1, 1), 1);
    box->axes = rotation();
    for (int k = 0; k < 3; ++k)
      box->half[k] = n / 4 % 3 == 0 && uniform(0, 1) < 0.5 ? 0 : std::pow(10, uniform(-3, 1));
  }
  Obb &a = boxes.a, &b = boxes.b;
  boxes.X_AB.m = rotation();
  if (n % 8 == 0) a.axes = b.axes = boxes.X_AB.m = Mat3::Identity();
  if (n % 8 == 1) boxes.X_AB.m = a.axes * b.axes.transpose();
  if (n % 8 == 2)
    boxes.X_AB.m =
        a.axes *
        Eigen::AngleAxisd(std::pow(10, uniform(-16, -2)), rotation().col(0)).toRotationMatrix() *
        b.axes.transpose();
  if (n % 8 == 3)  // parallel edges
    boxes.X_AB.m = a.axes * Eigen::AngleAxisd(uniform(0, 3), Vec3::UnitX()).toRotationMatrix() *
                   b.axes.transpose();
  const Mat3 ub = boxes.X_AB.m * b.axes;
  const int which = static_cast<int>(random() % 15);
  Vec3 L = which < 3   ? Vec3(a.axes.col(which))
           : which < 6 ? Vec3(ub.col(which - 3))
                       : Vec3(a.axes.col((which - 6) / 3).cross(ub.col((which - 6) % 3)));
  if (L.norm() < 1e-3) L = a.axes.col(0);
  L.normalize();
  const auto support = [&](const Obb& box, const Mat3& axes, double sign) {
    Vec3 p = Vec3::Zero();
    for (int k = 0; k < 3; ++k) {
      const double along = L.dot(axes.col(k));
      const double share = std::abs(along) < 1e-12 ? uniform(-1, 1) : std::copysign(1.0, along);
      p += sign * share * box.half[k] * axes.col(k);
    }
    return p;
  };
  boxes.scale = a.half.sum() + b.half.sum() + a.center.norm() + b.center.norm();
  boxes.step = std::pow(10, uniform(-17, -2)) * boxes.scale * (n & 1 ? 1 : -1);
  if (n % 16 == 8) boxes.step = 0;
  boxes.X_AB.t = a.center + support(a, a.axes, 1) - support(b, ub, -1) + boxes.step * L -
                 boxes.X_AB.m * b.center;
  const int exponent = n % 25 == 0 ? static_cast<int>(random() % 1800) - 900 : 0;
  const auto scaled = [&](double x) { return std::ldexp(x, exponent); };
  for (Vec3* v : {&a.center, &a.half, &b.center, &b.half, &boxes.X_AB.t}) *v = v->unaryExpr(scaled);
  boxes.scale = scaled(boxes.scale);
  boxes.step = scaled(boxes.step);
  return boxes;
}

VolumeBounds boundsOfBox(const Obb& box) {
  return {box.axisDefect(), box.centerReach(), roundedUp(box.centerReach() + box.radius())};
}

/// Returns the smallest gap at which the headers promise that the boxes are separated.
double clearGap(const Boxes& x) {
  const VolumeBounds a = boundsOfBox(x.a), b = boundsOfBox(x.b);
  const BoxPairMargins m =
      boxPairMargins(a.axisDefect, a.centerReach, b.axisDefect, b.centerReach, x.X_AB);
  return 4 * m.absolute + 32 * m.relative * x.scale;
}

template <class Overlap>
class ObbOverlaps : public testing::Test {
 protected:
  static PairTest<Obb, Overlap> of(const Boxes& x, double error = 0) {
    return {boundsOfBox(x.a), boundsOfBox(x.b), x.X_AB, error};
  }
};
using Overlaps = testing::Types<StandardOverlap, Gjk, LinearProgram, EdgeFace>;
struct OverlapNames {
  template <class Overlap>
  static std::string GetName(int) {
    if (std::is_same_v<Overlap, Gjk>) return "Gjk";
    if (std::is_same_v<Overlap, LinearProgram>) return "LinearProgram";
    return std::is_same_v<Overlap, EdgeFace> ? "EdgeFace" : "SeparatingAxes";
  }
};
TYPED_TEST_SUITE(ObbOverlaps, Overlaps, OverlapNames);

/// This test uses no rationals, so it can test many more pairs. If the separating-axis theorem
/// separates a pair by several times its rounding margin, every test must separate it.
TYPED_TEST(ObbOverlaps, SeparateBoxesThatAreClearlyApart) {
  std::mt19937_64 random(test::testSeed(64));
  const int rounds = (test::isStressRun() ? 10'000'000 : 100'000) / test::kSlowdown;
  int clear = 0, missed = 0;
  for (int n = 0; n < rounds; ++n) {
    const Boxes x = nearTouching(random, n);
    const PairTest<Obb> standard(boundsOfBox(x.a), boundsOfBox(x.b), x.X_AB, 0);
    if (!standard.separated(x.a, x.b, clearGap(x))) continue;
    ++clear;
    missed += !TestFixture::of(x).separated(x.a, x.b, 0);
  }
  EXPECT_EQ(missed, 0) << "of " << clear;
  EXPECT_GT(clear, rounds / 4);
}

TYPED_TEST(ObbOverlaps, APadIsADistance) {
  std::mt19937_64 random(test::testSeed(62));
  int separatedPairs = 0;
  for (int n = 1; n < 10'000; n += 2) {
    const Boxes x = nearTouching(random, n);
    const auto test = TestFixture::of(x);
    // The distance of the two supporting features is the step, up to rounding.
    const double distance = x.step * (1 + 1e-9) + 1e-13 * x.scale;
    ASSERT_FALSE(test.separated(x.a, x.b, distance)) << n;
    ASSERT_FALSE(TestFixture::of(x, distance).separated(x.a, x.b, 0)) << n;
    if (x.step > 1e-9 * x.scale) {
      ++separatedPairs;
      ASSERT_TRUE(test.separated(x.a, x.b, x.step / 8)) << n;
    }
  }
  EXPECT_GT(separatedPairs, 1000);
}

/// Faces, edges and corners that meet exactly; no number is rounded.
TYPED_TEST(ObbOverlaps, ExactlyTouching) {
  Boxes x;
  x.a.half = x.b.half = Vec3(1, 2, 3);
  for (const Vec3& t : {Vec3(2, 0, 0), Vec3(2, 1, -5), Vec3(2, 4, 0.5), Vec3(-2, 4, 6),
                        Vec3(0, 0, 6), Vec3(0, 0, 0), Vec3(0.5, -0.25, 0)}) {
    x.X_AB.t = t;
    EXPECT_FALSE(TestFixture::of(x).separated(x.a, x.b, 0)) << t.transpose();
    x.X_AB.t = (1 + 0x1p-30) * t;
    EXPECT_EQ(TestFixture::of(x).separated(x.a, x.b, 0), t.norm() > 1) << t.transpose();
  }
  x.X_AB.t = Vec3(0.5, 0, 0);  // box a contains box b, or b contains a, or one box is flat
  for (const double size : {0.0, 0.25, 100.0}) {
    x.b.half = Vec3::Constant(size);
    EXPECT_FALSE(TestFixture::of(x).separated(x.a, x.b, 0)) << size;
  }
  x.a.half = x.b.half = Vec3::Zero();
  EXPECT_TRUE(TestFixture::of(x).separated(x.a, x.b, 0)) << "two points";
  x.X_AB.t = Vec3::Zero();
  EXPECT_FALSE(TestFixture::of(x).separated(x.a, x.b, 0)) << "one point";
}

TYPED_TEST(ObbOverlaps, NonFiniteBoxesAreNotSeparated) {
  std::mt19937_64 random(test::testSeed(63));
  const double nan = std::nan("");
  for (int n = 1; n < 200; ++n) {
    Boxes x = nearTouching(random, 8 * n + 5);
    x.X_AB.t += 100 * x.scale * Vec3::UnitX();
    ASSERT_TRUE(TestFixture::of(x).separated(x.a, x.b, 0)) << n;
    for (const double bad : {HUGE_VAL, -HUGE_VAL, nan}) {
      const int axis = n % 3;
      const auto blind = [&](const auto& spoil, const char* what) {
        Boxes spoilt = x;
        spoil(spoilt);
        EXPECT_FALSE(TestFixture::of(spoilt).separated(spoilt.a, spoilt.b, 0))
            << what << " " << bad;
        // The same test, with bounds that were computed from the boxes before the NaN or infinity
        // was inserted.
        EXPECT_FALSE(TestFixture::of(x).separated(spoilt.a, spoilt.b, 0)) << what << " " << bad;
      };
      blind([&](Boxes& y) { y.a.center[axis] = bad; }, "centre of a");
      blind([&](Boxes& y) { y.b.center[axis] = bad; }, "centre of b");
      if (bad > 0) blind([&](Boxes& y) { y.a.half[axis] = bad; }, "size of a");
      if (bad > 0) blind([&](Boxes& y) { y.b.half[axis] = bad; }, "size of b");
      Boxes posed = x;
      posed.X_AB.t[axis] = bad;
      EXPECT_FALSE(TestFixture::of(posed).separated(x.a, x.b, 0)) << bad;
      EXPECT_FALSE(TestFixture::of(x, std::abs(bad)).separated(x.a, x.b, 0)) << bad;
    }
    Boxes far = x;  // sums overflow
    far.X_AB.t *= 1e308 / x.scale / 100;
    far.a.center = -far.X_AB.t;
    EXPECT_FALSE(TestFixture::of(far).separated(far.a, far.b, 0));
  }
}

/// One loop runs all four overlap tests, so that the slow rational answer is computed once per
/// pair.
TEST(ObbOverlapsAgainstRationals, AgreeUpToTheMargin) {
  std::mt19937_64 random(test::testSeed(61));
  const int rounds = test::casesOf(400, 100'000);
  const char* const names[] = {"separating axes", "GJK", "linear program", "edges and faces"};
  int touching = 0, apart = 0, clear[4] = {}, separatedPairs[4] = {};
  for (int n = 0; n < rounds; ++n) {
    const Boxes x = nearTouching(random, n);
    const Truth truth(x.a, x.b, x.X_AB);
    (truth.touch ? touching : apart) += 1;
    const VolumeBounds a = boundsOfBox(x.a), b = boundsOfBox(x.b);
    const double margin = clearGap(x);
    const auto look = [&](int which, const auto& test, double gap) {
      const bool separated = test.separated(x.a, x.b, 0);
      separatedPairs[which] += separated;
      if (truth.touch) {
        EXPECT_FALSE(separated) << names[which] << ", case " << n << ", " << x.step / x.scale;
      } else if (gap > margin) {
        ++clear[which];
        EXPECT_TRUE(separated) << names[which] << ", case " << n << ", " << gap / x.scale;
      }
    };
    // Here, cross products of axes are not normalised.
    look(0, PairTest<Obb>(a, b, x.X_AB, 0), truth.raw);
    look(1, PairTest<Obb, Gjk>(a, b, x.X_AB, 0), truth.widest);
    look(2, PairTest<Obb, LinearProgram>(a, b, x.X_AB, 0), truth.widest);
    look(3, PairTest<Obb, EdgeFace>(a, b, x.X_AB, 0), truth.widest);
  }
  std::cout << touching << " touch, " << apart
            << " are apart; reported as separated, clearly apart:";
  for (int i = 0; i < 4; ++i) {
    std::cout << " " << names[i] << " " << separatedPairs[i] << ", " << clear[i] << ";";
    EXPECT_GT(clear[i], rounds / 4);
  }
  std::cout << "\n";
  EXPECT_GT(touching, rounds / 4);
}

}  // namespace
}  // namespace corridor
