#include "collision/convex/gjk.h"

#include <iomanip>
#include <iostream>

#include <gtest/gtest.h>

#include "tests/collision/convex/touching_pairs.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::Shape;
using test::ShapeFeature;
using test::Touching;

/// Tests that two figures of a search are below limits, and prints their largest values. They are
/// the number of iterations, and the difference between the final upper and lower bounds of the
/// cores' distance, divided by the size.
TEST(Gjk, WorstErrors) {
  Touching make(test::testSeed(24));
  const char* names[] = {"box", "sphere", "capsule", "cylinder", "convex", "triangle"};
  for (const Shape sa : test::kShapes)
    for (const Shape sb : test::kShapes) {
      if (sb < sa) continue;
      double inDouble = 0, inDoubleDouble = 0;
      int roundsInDouble = 0, roundsInDoubleDouble = 0;
      for (int n = 0; n < 2'000; ++n) {
        const ShapeFeature a = make.feature(sa), b = make.feature(sb);
        const Vec3 normal = n % 5 == 0 ? Vec3(Vec3::Unit(n / 5 % 3)) : make.vector().normalized();
        const Transform X_WA = make.pose(a, Vec3::Zero(), normal);
        Transform X_WB = make.pose(b, Vec3::Zero(), -normal);
        X_WB.t += normal * std::pow(10.0, -1 - n % 13);
        const PosedSet setA(a.set(), X_WA), setB(b.set(), X_WB);
        const double size = setA.reach() + setB.reach() + X_WA.t.norm() + X_WB.t.norm();
        const auto never = [](const Vec3&, double, std::uint32_t, std::uint32_t) { return false; };
        const auto error = [&](const gjk::Answer& answer) {
          return (answer.upper - answer.lower) / size;
        };
        const double near = 0x1p-49 * size;
        const gjk::Answer d = gjk::search<double>(setA, setB, size, near, never);
        const gjk::Answer dd = gjk::search<DoubleDouble>(setA, setB, size, near, never);
        inDouble = std::max(inDouble, error(d));
        roundsInDouble = std::max(roundsInDouble, d.rounds);
        if (dd.overlap || dd.upper <= near) continue;
        // The difference that is allowed is 2^-36 of the distance, or 2^-50 of the size.
        inDoubleDouble =
            std::max(inDoubleDouble, (dd.upper - dd.lower) / std::max(size, 0x1p14 * dd.upper));
        roundsInDoubleDouble = std::max(roundsInDoubleDouble, dd.rounds);
      }
      std::cout << "///   " << std::left << std::setw(9) << names[int(sa)] << std::setw(9)
                << names[int(sb)] << std::setprecision(1) << std::scientific << inDouble
                << std::setw(4) << std::right << roundsInDouble << "   " << inDoubleDouble
                << std::setw(4) << roundsInDoubleDouble << "\n";
      EXPECT_LE(inDoubleDouble, 0x1.01p-50) << names[int(sa)] << " " << names[int(sb)];
      EXPECT_LT(roundsInDoubleDouble, 200);
    }
}

/// The search must end even for sets that overlap by less than the rounding of the corners.
TEST(Gjk, BarelyOverlappingSetsEnd) {
  Touching make(test::testSeed(25));
  int most = 0;
  for (const Shape sa : test::kShapes)
    for (const Shape sb : test::kShapes)
      for (int n = 0; n < 1'000 / test::kSlowdown; ++n) {
        const ShapeFeature a = make.feature(sa), b = make.feature(sb);
        const Vec3 normal = make.vector().normalized();
        const Transform X_WA = make.pose(a, Vec3::Zero(), normal);
        Transform X_WB = make.pose(b, Vec3::Zero(), -normal);
        X_WB.t -= normal * std::pow(10.0, -8 - n % 5);
        const PosedSet setA(a.set(), X_WA), setB(b.set(), X_WB);
        const double size = setA.reach() + setB.reach() + X_WA.t.norm() + X_WB.t.norm();
        const auto never = [](const Vec3&, double, std::uint32_t, std::uint32_t) { return false; };
        most = std::max(most,
                        gjk::search<DoubleDouble>(setA, setB, size, 0x1p-49 * size, never).rounds);
      }
  std::cout << "rounds: at most " << most << "\n";
  EXPECT_LT(most, 200);
}

TEST(DoubleDouble, HasAHundredBits) {
  const DoubleDouble third = DoubleDouble(1) / DoubleDouble(3);
  EXPECT_LT(std::abs(static_cast<double>(third * DoubleDouble(3) - DoubleDouble(1))), 0x1p-100);
  const DoubleDouble root = sqrt(DoubleDouble(2));
  EXPECT_LT(std::abs(static_cast<double>(root * root - DoubleDouble(2))), 0x1p-98);
  EXPECT_EQ(static_cast<double>(DoubleDouble(1) + DoubleDouble(0x1p-80) - DoubleDouble(1)),
            0x1p-80);
}

}  // namespace
}  // namespace corridor
