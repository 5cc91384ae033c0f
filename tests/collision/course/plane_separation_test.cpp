#include "collision/course/plane_separation.h"

#include <cmath>
#include <iostream>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/cpp_int.hpp>
#include <gtest/gtest.h>

#include "tests/collision/convex/posed_polytopes.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using Rational = boost::multiprecision::cpp_rational;
using Wide = boost::multiprecision::cpp_bin_float_100;

Rational height(const HalfSpace<3>& half, const Vec3& x) {
  Rational sum = -Rational(half.offset);
  for (int k = 0; k < 3; ++k) sum += Rational(half.normal[k]) * Rational(x[k]);
  return sum;
}

/// Makes planes of all kinds: random; through a vertex; along a face; and one unit in the last
/// place off a face.
HalfSpace<3> plane(test::ExactPairs& random, const Polytope& polytope, int kind) {
  const auto vertices = polytope.vertices();
  const auto any = [&] { return vertices[random.pick(static_cast<int>(vertices.size()))]; };
  HalfSpace<3> half{random.vector(), 2 * random.real()};
  if (kind == 1) half.normal = Vec3(Vec3::Unit(random.pick(3))) * (random.pick(2) ? 3 : -0.5);
  if (kind == 2) {
    const auto& f = polytope.faces()[random.pick(static_cast<int>(polytope.faces().size()))];
    half.normal = (vertices[f[1]] - vertices[f[0]]).cross(vertices[f[2]] - vertices[f[0]]);
    half.offset = half.normal.dot(vertices[f[0]]);  // a product of factors with few bits; it is
                                                    // mostly exact
    if (random.pick(3) == 0) half.offset = std::nextafter(half.offset, random.pick(2) ? 9 : -9);
  }
  if (kind == 3) half.offset = half.normal.dot(any());
  if (kind == 4) {
    const double scale = std::ldexp(1.0, random.pick(2) ? 500 : -500);
    half.normal *= scale, half.offset *= scale;
  }
  return half;
}

TEST(PlaneSeparation, AgreesWithEveryVertexInRationals) {
  test::ExactPairs random(test::testSeed(71));
  int sides[3] = {0, 0, 0}, touching = 0;
  const int count = test::isStressRun() ? 50'000 : 700 / test::kSlowdown;
  for (int n = 0; n < count; ++n) {
    std::vector<Vec3> points;
    const Polytope drawn = random.polytope(n % random.kKinds);
    const bool isFar = n % 4 == 0 || n % 6 == 5;
    const Vec3 away = isFar ? Vec3(1e6, -1e6, 3) : Vec3(Vec3::Zero());
    for (const Vec3& p : drawn.vertices()) points.push_back(p + away);
    const DobkinKirkpatrick polytope{Polytope(points)};
    HalfSpace<3> half = plane(random, polytope.polytope(), n % 6);
    if (n % 6 == 5) {
      // The plane is through the outermost vertex, up to rounding: doubles cannot decide the side.
      half.offset = 0;
      Rational most = height(half, points[0]);
      for (const Vec3& p : points) most = std::max(most, height(half, p));
      half.offset = static_cast<double>(most);
    }
    Rational low = height(half, points[0]), high = low;
    for (const Vec3& p : points) {
      low = std::min(low, height(half, p));
      high = std::max(high, height(half, p));
    }
    const int side = low > 0 ? 1 : high < 0 ? -1 : 0;
    const PlaneSeparation found = planeSeparation(polytope, half);
    ASSERT_EQ(found.side, side) << n;
    ASSERT_EQ(sideOfPlane(polytope, half), side) << n;
    const auto vertices = polytope.polytope().vertices();
    ASSERT_EQ(height(half, vertices[found.innermost]), low) << n;
    ASSERT_EQ(height(half, vertices[found.outermost]), high) << n;
    EXPECT_TRUE(found.witness == found.innermost || found.witness == found.outermost) << n;
    Wide length = 0;
    for (int k = 0; k < 3; ++k) length += Wide(half.normal[k]) * Wide(half.normal[k]);
    length = sqrt(length);
    const Rational most = std::max(low, Rational(-high));
    const Wide separation = Wide(numerator(most)) / Wide(denominator(most)) / length;
    EXPECT_LE(Wide(found.lower), separation) << n;
    EXPECT_GE(Wide(found.upper), separation) << n;
    // With u = 2^-53, a height is off by 8u times its terms, and rounding a bound adds 2^-48 = 32u.
    // Together, both bounds are off by 80u.
    const double size =
        std::sqrt(3.0) * (1e6 * isFar + 4) + std::abs(half.offset) / half.normal.norm();
    EXPECT_LE(found.upper - found.lower, 96 * 0x1p-53 * size) << n;
    // The height of the witness must be between the two bounds of the separation.
    const Rational there = height(half, vertices[found.witness]);
    const Wide value = abs(Wide(numerator(there)) / Wide(denominator(there)) / length);
    EXPECT_LE(abs(value - abs(separation)), Wide(found.upper - found.lower)) << n;
    ++sides[side + 1];
    touching += low == 0 || high == 0;
  }
  std::cout << sides[0] << " inside, " << sides[2] << " outside, " << sides[1] << " across; "
            << touching << " touching\n";
  EXPECT_GT(sides[0], count / 20);
  EXPECT_GT(sides[2], count / 20);
  EXPECT_GT(sides[1], count / 5);
  EXPECT_GT(touching, count / 20);
}

/// If the plane cuts the polytope, −`lower` is the length of the translation that just takes the
/// polytope off the plane.
TEST(PlaneSeparation, DepthsLeadOffThePlane) {
  test::ExactPairs random(test::testSeed(72));
  for (int n = 0; n < 100; ++n) {
    const DobkinKirkpatrick polytope{random.polytope(n % random.kKinds)};
    HalfSpace<3> half{random.vector().normalized(), 0.2 * random.real()};
    const PlaneSeparation found = planeSeparation(polytope, half);
    if (found.side != 0) continue;
    // Moves the plane instead of the polytope.
    const double out = found.witness == found.innermost ? -1 : 1;
    half.offset += out * (-found.lower + 1e-12);
    EXPECT_EQ(sideOfPlane(polytope, half), -out) << n;
    half.offset -= out * 2e-12;
    EXPECT_EQ(sideOfPlane(polytope, half), 0) << n;
  }
}

TEST(PlaneSeparation, OneUlpDecides) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) corners.emplace_back(i & 1, i >> 1 & 1, i >> 2);
  const DobkinKirkpatrick cube{Polytope(corners)};
  const Vec3 n = Vec3::Ones();
  EXPECT_EQ(sideOfPlane(cube, {n, 3}), 0);
  EXPECT_EQ(sideOfPlane(cube, {n, std::nextafter(3.0, 4.0)}), -1);
  EXPECT_EQ(sideOfPlane(cube, {n, 0}), 0);
  const double e = std::numeric_limits<double>::denorm_min();
  EXPECT_EQ(sideOfPlane(cube, {n, -e}), 1);
  EXPECT_EQ(planeSeparation(cube, {n, -e}).side, 1);
  EXPECT_EQ(planeSeparation(cube, {e * n, 0}).side, 0);
  const PlaneSeparation across = planeSeparation(cube, {Vec3::UnitX(), 0.25});
  EXPECT_EQ(across.side, 0);
  EXPECT_NEAR(across.lower, -0.25, 1e-14);
  EXPECT_NEAR(across.upper, -0.25, 1e-14);
  EXPECT_EQ(across.witness, across.innermost);
  EXPECT_THROW(planeSeparation(cube, {Vec3::Zero(), 1}), std::invalid_argument);
  EXPECT_THROW(sideOfPlane(cube, {n, std::nan("")}), std::invalid_argument);
}

/// If heights overflow, the bounds prove nothing, but the side is exact.
TEST(PlaneSeparation, OverflowGivesInfiniteBounds) {
  const double e = 1e308;
  const std::vector<Vec3> points = {{e, e, e}, {1.1 * e, e, e}, {e, 1.1 * e, e}, {e, e, 1.1 * e}};
  const Polytope polytope(points);
  const PlaneSeparation found = planeSeparation(DobkinKirkpatrick(polytope), {Vec3::Ones(), 0});
  EXPECT_EQ(found.side, 1);
  EXPECT_GE(found.lower, 0);
  EXPECT_EQ(found.upper, HUGE_VAL);
}

/// Rounded heights of all vertices are 0, so only exact heights find the closest vertex.
TEST(PlaneSeparation, TheWitnessIsTheClosestVertex) {
  const std::vector<Vec3> points = {
      {0x1.64c7aec5603cdp+0, 0x1.6e854e2033adcp-2, 0x1.6c7f55d3164d5p-8},
      {0x1.64c7aec5603cep+0, 0x1.228b16adf80a7p-2, 0x1.227feba13fc46p-9},
      {0x1.64c7aec5603cep+0, 0x1.0892e9f6420fap-2, 0x1.4763903f2b162p-9},
      {0x1.64c7aec5603cep+0, 0x1.2dff2f083e315p-2, 0x1.073458ac5ff48p-7}};
  const Polytope polytope(points);
  const PlaneSeparation found = planeSeparation(
      DobkinKirkpatrick(polytope), {Vec3(1.5, 0x1p-51, 0x1p-51), 0x1.0b95c314082dap+1});
  ASSERT_EQ(found.side, 1);
  EXPECT_EQ(found.witness, found.innermost);
}

}  // namespace
}  // namespace corridor
