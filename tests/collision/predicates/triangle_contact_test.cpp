#include "collision/predicates/triangle_contact.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>

#ifdef __SSE2__
#include <xmmintrin.h>
#endif

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "collision/core/rounding.h"
#include "tests/support/rational_contact.h"
#include "tests/support/support.h"
#include "tests/support/triangle_pairs.h"

namespace corridor {
namespace {

bool touch(const Triangle& a, const Triangle& b, const Transform& X_WA = {},
           const Transform& X_WB = {}) {
  const bool answer = trianglesTouch(a, X_WA, b, X_WB);
  EXPECT_EQ(answer, trianglesTouchExact(a, X_WA, b, X_WB));
  EXPECT_EQ(answer, trianglesTouch(b, X_WB, a, X_WA)) << "not symmetric";
  return answer;
}

TEST(TriangleContact, SharedData) {
  const auto data = test::dataFolder();
  if (!data) GTEST_SKIP() << "set CORRIDOR_DATA to the folder of shared test data";
  const auto files = test::sharedPairs(*data / "collision");
  std::size_t count = 0;
  for (const auto& [name, pairs] : files) {
    for (std::size_t n = 0; n < pairs.size(); ++n)
      EXPECT_EQ(touch(pairs[n].a, pairs[n].b), pairs[n].touch) << name << " " << n;
    count += pairs.size();
  }
  EXPECT_GT(files.size(), 5U);
  EXPECT_GT(count, 10'000U);
  std::cout << files.size() << " files, " << count << " pairs\n";
}

/// Checks the predicates against rational arithmetic that shares no code with them, on triangles
/// and maps that are often degenerate.
class RandomTriangles : public testing::TestWithParam<const char*> {};

TEST_P(RandomTriangles, AgreesWithRationals) {
  const std::string kind = GetParam();
  std::mt19937_64 random(test::testSeed(20261121));
  const auto integer = [&](int n) {
    return static_cast<double>(std::uniform_int_distribution(-n, n)(random));
  };
  const auto real = [&] { return std::uniform_real_distribution(-1.0, 1.0)(random); };
  const auto rotation = [&] {
    return Mat3(Eigen::Quaterniond(real(), real(), real(), real()).normalized().toRotationMatrix());
  };
  const int cases = test::isStressRun() ? 200'000 : 1'000;
  int touching = 0;
  for (int n = 0; n < cases; ++n) {
    Triangle a, b;
    Transform X_WA, X_WB;
    for (Triangle* t : {&a, &b})
      for (Vec3& v : *t)
        v = kind == "grid" ? Vec3(integer(2), integer(2), integer(2))
                           : Vec3(real(), real(), real());
    if (kind == "common corner, moved together") {  // by the same map, so the triangles still touch
      b[0] = a[0];
      X_WA = X_WB = {rotation(), {real() * 1e6, real(), real()}};
    } else if (kind == "maps nearly rigid") {
      X_WA = {rotation() * (1 + 1e-9 * real()), {real(), real(), real()}};
      X_WB = {Mat3(rotation() + 1e-9 * Mat3::Random()), {real(), real(), real()}};
    } else if (kind == "grazing, mapped far out") {
      // b's lowest corner is above or below a's face by less than the rounding of mapped corners.
      X_WA = {rotation(), Vec3(real(), real(), real()) * 1e6};
      X_WB = {rotation(), X_WA.t};
      const Vec3 normal = (a[1] - a[0]).cross(a[2] - a[0]).normalized();
      const Vec3 tip = (a[0] + a[1] + a[2]) / 3 + 1e-10 * real() * normal;
      const Vec3 from[3] = {tip, tip + normal + 0.5 * b[1], tip + normal + 0.5 * b[2]};
      for (int i = 0; i < 3; ++i) b[i] = X_WB.m.transpose() * (X_WA.m * from[i]);
    } else if (kind == "flat and far") {
      for (Triangle* t : {&a, &b})
        for (Vec3& v : *t) v = Vec3(1e6 + integer(3), 1e-9 * integer(2), 1e6 + integer(3));
      X_WB.m(1, 0) = 1e-15 * integer(1);
    } else if (kind == "exponents apart") {
      for (Triangle* t : {&a, &b})
        for (Vec3& v : *t)
          v = Vec3(std::ldexp(real(), static_cast<int>(integer(500))), integer(1),
                   integer(1) * 0x1p-1060);
    } else if (kind == "denormal") {
      for (Triangle* t : {&a, &b})
        for (Vec3& v : *t) v = Vec3(integer(2), integer(2), integer(2)) * 0x1p-1074;
      X_WB.m = 0.5 * Mat3::Identity();
    }
    const bool expected = test::rationalContact(a, X_WA, b, X_WB);
    touching += expected;
    ASSERT_EQ(touch(a, b, X_WA, X_WB), expected) << kind << ", case " << n;
  }
  EXPECT_GT(touching, cases / 100) << "the generator must produce touching and separate pairs";
  EXPECT_LT(touching, kind == "common corner, moved together" ? cases + 1 : cases);
}
INSTANTIATE_TEST_SUITE_P(Kinds, RandomTriangles,
                         testing::Values("grid", "common corner, moved together",
                                         "maps nearly rigid", "grazing, mapped far out",
                                         "flat and far", "exponents apart", "denormal"),
                         [](const auto& parameter) {
                           std::string name = parameter.param;
                           std::erase_if(name, [](char c) {
                             return !std::isalnum(static_cast<unsigned char>(c));
                           });
                           return name;
                         });

TEST(TriangleContact, DegenerateTrianglesAreTheirPointSets) {
  const Triangle face = {Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)};
  const auto point = [](double x, double y, double z) {
    return Triangle{Vec3(x, y, z), Vec3(x, y, z), Vec3(x, y, z)};
  };
  EXPECT_TRUE(touch(face, point(1, 1, 0)));
  EXPECT_TRUE(touch(face, point(2, 2, 0)));
  EXPECT_FALSE(touch(face, point(std::nextafter(2.0, 3.0), 2, 0)));
  EXPECT_FALSE(touch(face, point(1, 1, 0x1p-1074)));
  EXPECT_TRUE(touch(point(3, 5, 7), point(3, 5, 7)));
  EXPECT_FALSE(touch(point(3, 5, 7), point(3, 5, std::nextafter(7.0, 8.0))));
  const Triangle segment = {Vec3(1, 1, -1), Vec3(1, 1, 1), Vec3(1, 1, 0.25)};
  EXPECT_TRUE(touch(face, segment));
  EXPECT_TRUE(touch(segment, point(1, 1, 0.5)));
  EXPECT_FALSE(touch(segment, point(1, 1, 1.5)));
  const Triangle collinear = {Vec3(1, 1, 1), Vec3(1, 1, 3), Vec3(1, 1, 2)};
  EXPECT_TRUE(touch(segment, collinear));
  // Triangles that are segments, and share only one end. No edge of these triangles is a single
  // point.
  const Triangle first = {Vec3(0, 0, 0), Vec3(1, 1, 0), Vec3(2, 2, 0)};
  for (const Vec3& d : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(1, 3, 2), Vec3(0, 0, 1)}) {
    const Triangle second = {Vec3(2, 2, 0), Vec3(Vec3(2, 2, 0) + d), Vec3(Vec3(2, 2, 0) + 2 * d)};
    EXPECT_TRUE(touch(first, second)) << d.transpose();
    EXPECT_TRUE(touch(second, first)) << d.transpose();
    Triangle apart = second;
    for (Vec3& corner : apart) corner.x() += 0x1p-51;
    EXPECT_FALSE(touch(first, apart)) << d.transpose();
  }
}

#ifdef __SSE2__
/// A corner touches a face, or is off the face by a subnormal number. This number is a coordinate
/// of the corner, or an entry of the matrix or of the translation of the map. The verdict must be
/// right even if the processor reads subnormals as zero: a linked library may have set this mode.
TEST(TriangleContact, SubnormalsThatAreReadAsZero) {
  const Triangle face = {Vec3(-8, -8, 0), Vec3(8, -8, 0), Vec3(0, 8, 0)};
  const Triangle tip = {Vec3(1, 2, 0), Vec3(1, 2, 4), Vec3(2, 2, 4)};
  Triangle corner = tip;
  corner[0][2] = 0x1p-1040;
  Transform turn, shift;
  turn.m(2, 0) = 0x1p-1040;
  shift.t[2] = 0x1p-1040;
  const unsigned before = _mm_getcsr();
  _mm_setcsr(before | 0x8040);
  const bool touches[] = {touch(face, tip), touch(face, corner), touch(face, tip, {}, turn),
                          touch(face, tip, {}, shift)};
  _mm_setcsr(before);
  EXPECT_TRUE(touches[0]);
  EXPECT_FALSE(touches[1]) << "corner";
  EXPECT_FALSE(touches[2]) << "map";
  EXPECT_FALSE(touches[3]) << "shift";
}
#endif

/// A corner is in the other triangle's plane, or about one unit off this plane, on grids of 4 to
/// 200 bits. Beyond 50 bits, another corner is on a finer grid. Each integer type is therefore used
/// up to its last bit, so that an overflow would be detected.
TEST(TriangleContact, GridsOfAnyNumberOfBits) {
  std::mt19937_64 random(test::testSeed(53));
  int touching = 0, cases = 0;
  for (int bits = 4; bits <= 200; bits += bits < 90 ? 1 : 10)
    for (int n = 0; n < 60 / test::kSlowdown + 2; ++n, ++cases) {
      // A coordinate has at most 50 bits. b[1], scaled by `gridStep`, uses the grid's lowest bits;
      // all other corners use its highest bits.
      const auto integer = [&] {
        const int used = std::min(bits, 50);
        return static_cast<double>(static_cast<std::int64_t>(random() >> (64 - used)) -
                                   (std::int64_t{1} << (used - 1)));
      };
      const auto point = [&] { return Vec3(integer(), integer(), integer()); };
      const double gridStep = std::exp2(-std::max(bits - 50, 0));
      Triangle a = {point(), point(), point()}, b = {point(), point(), point()};
      const double s = 0.25, t = 0.375;
      b[0] = (a[0] + s * (a[1] - a[0]) + t * (a[2] - a[0])).array().round();
      if (n % 3 == 1) b[0] = a[n % 2];  // touches exactly
      if (n % 3 == 2) b[0][n % 3] += n % 2 ? 1 : -1;
      if (bits > 50) b[1] *= gridStep;  // corners on a coarse and on a fine grid
      Transform X_WB;
      if (n % 2) X_WB.m << 0, -1, 0, 1, 0, 0, 0, 0, 1;
      for (Vec3& p : b) p = X_WB.m.transpose() * p;
      const bool expected = test::rationalContact(a, {}, b, X_WB);
      ASSERT_EQ(touch(a, b, {}, X_WB), expected) << bits << " bits, case " << n;
      touching += expected;
    }
  EXPECT_GT(touching, cases / 4);
  EXPECT_LT(touching, cases - cases / 8);
}

/// Contact is defined by the exact images of the corners. Rounded images would give the opposite
/// answer.
TEST(TriangleContact, TheMapsAreExactNotTheirRoundedImages) {
  const Triangle floor = {Vec3(-8, -8, 0), Vec3(8, -8, 0), Vec3(0, 8, 0)};
  const Triangle tip = {Vec3(0, 0, 1), Vec3(1, 0, 2), Vec3(-1, 0, 2)};
  // The tip's height is m·v − fl(m·v), where the product m·v needs more than 53 bits.
  const double m = 1 + 0x1p-30, v = 1 + 0x1p-31;
  Triangle scaled = tip;
  scaled[0][2] = v;
  Transform X_WB;
  X_WB.m(2, 2) = m;
  X_WB.t[2] = -(m * v);  // the rounded product: m·v − fl(m·v) = 2^-61 > 0
  EXPECT_FALSE(touch(floor, scaled, {}, X_WB));
  X_WB.t[2] = std::nextafter(X_WB.t[2], -10);
  EXPECT_TRUE(touch(floor, scaled, {}, X_WB));
}

TEST(TriangleContact, VerdictsSurviveExactRotationsAndScaling) {
  std::mt19937_64 random(test::testSeed(7));
  const auto integer = [&](int n) {
    return static_cast<double>(std::uniform_int_distribution(-n, n)(random));
  };
  for (int n = 0; n < 300; ++n) {
    Triangle a, b;
    for (Triangle* t : {&a, &b})
      for (Vec3& v : *t) v = Vec3(integer(3), integer(3), integer(3)) / 3;
    const bool answer = touch(a, b);
    int order[3] = {0, 1, 2};
    do {
      for (int signs = 0; signs < 8; ++signs) {
        Transform X;
        X.m.setZero();
        for (int i = 0; i < 3; ++i)
          X.m(i, order[i]) = std::ldexp(signs >> i & 1 ? -1 : 1, 40 - n % 80);
        ASSERT_EQ(touch(a, b, X, X), answer);
      }
    } while (std::next_permutation(order, order + 3));
  }
}

}  // namespace
}  // namespace corridor
