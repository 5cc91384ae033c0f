#include "collision/course/separating_plane.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <limits>
#include <random>
#include <span>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "tests/collision/convex/hull_pairs.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::Points;

template <int D>
SeparatingPlane<D> planeOf(const Points<D>& p, const Points<D>& q, std::uint64_t seed = 1) {
  return separatingPlane<D>(std::span(p), std::span(q), seed);
}

template <int D>
Points<D> chosen(const Points<D>& points, const std::vector<std::size_t>& indices) {
  Points<D> result;
  for (const std::size_t i : indices) result.push_back(points.at(i));
  return result;
}

/// Compares the relation with the oracle's, and tests the witness of each answer.
template <int D>
void compareSets(int count, std::uint64_t seed) {
  test::HullPairs<D> pairs(seed);
  std::array<int, 3> seen{};
  int exact = 0;
  for (int n = 0; n < count; ++n) {
    const auto [p, q] = pairs.next();
    const SeparatingPlane<D> found = planeOf<D>(p, q, static_cast<std::uint64_t>(n));
    const HullRelation truth = test::hullRelation<D>(p, q);
    ASSERT_EQ(found.relation, truth) << "pair " << n;
    ++seen[static_cast<std::size_t>(truth)];
    exact += found.exact;
    ASSERT_LE(found.first.size() + found.second.size(), D + 2u);
    double size = 0;
    for (const auto& x : p) size = std::max(size, x.cwiseAbs().maxCoeff());
    for (const auto& x : q) size = std::max(size, x.cwiseAbs().maxCoeff());
    if (truth == HullRelation::overlapping) {
      EXPECT_TRUE(found.normal.isZero(0));
    } else {
      ASSERT_GT(found.normal.norm(), 0) << "pair " << n;
      const bool strict = truth == HullRelation::disjoint && !found.exact;
      const double error = strict ? 0 : 1e-15 * (size * found.normal.template lpNorm<1>() + 1);
      for (const auto& x : p) EXPECT_LE(found.normal.dot(x) - found.offset, error) << "pair " << n;
      for (const auto& x : q) EXPECT_GE(found.normal.dot(x) - found.offset, -error) << "pair " << n;
    }
    if (truth != HullRelation::disjoint) {
      // The hulls of the reported vertices alone share a point, which is near the reported point.
      const Points<D> a = chosen(p, found.first), b = chosen(q, found.second);
      EXPECT_NE(test::hullRelation<D>(a, b), HullRelation::disjoint) << "pair " << n;
      const Eigen::Matrix<double, D, 1> half =
          Eigen::Matrix<double, D, 1>::Constant(1e-12 * size + 1e-300);
      Points<D> box;
      for (int corner = 0; corner < (1 << D); ++corner) {
        Eigen::Matrix<double, D, 1> x = found.point;
        for (int k = 0; k < D; ++k) x[k] += corner >> k & 1 ? half[k] : -half[k];
        box.push_back(x);
      }
      EXPECT_NE(test::hullRelation<D>(a, box), HullRelation::disjoint) << "pair " << n;
      EXPECT_NE(test::hullRelation<D>(b, box), HullRelation::disjoint) << "pair " << n;
    }
  }
  std::cout << "disjoint " << seen[0] << ", touching " << seen[1] << ", overlapping " << seen[2]
            << "; decided in rationals: " << exact << "\n";
  for (const int each : seen) EXPECT_GT(each, count / 20);
}

int numberOfSets() {
  return test::casesOf(380, 100'000);
}

TEST(SeparatingPlane, AgreesWithRationalSimplexInSpace) {
  compareSets<3>(numberOfSets(), test::testSeed(5));
}
TEST(SeparatingPlane, AgreesWithRationalSimplexInThePlane) {
  compareSets<2>(numberOfSets(), test::testSeed(6));
}

TEST(SeparatingPlane, OneUlpDecides) {
  const double below = std::nextafter(1.0, 0.0);
  const Points<3> square = {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  const auto spike = [](double z) { return Points<3>{{0.3, 0.4, z}, {0, 0, -1}, {1, 0, -1}}; };
  EXPECT_EQ(planeOf<3>(square, spike(below)).relation, HullRelation::disjoint);
  EXPECT_EQ(planeOf<3>(square, spike(1)).relation, HullRelation::touching);
  Points<3> pyramid = square;
  pyramid.push_back({0.3, 0.4, 3});
  EXPECT_EQ(planeOf<3>(pyramid, spike(1)).relation, HullRelation::touching);
  EXPECT_EQ(planeOf<3>(pyramid, spike(std::nextafter(1.0, 2.0))).relation,
            HullRelation::overlapping);
}

TEST(SeparatingPlane, SizesAtTheEndsOfTheRange) {
  for (const double size : {1e-300, 1e300}) {
    const Points<2> a = {{0, 0}, {size, 0}, {0, size}},
                    b = {{0.5 * size, 0.5 * size}, {size, size}},
                    c = {{0.6 * size, 0.5 * size}, {size, size}};
    EXPECT_EQ(planeOf<2>(a, b).relation, HullRelation::touching);
    EXPECT_EQ(planeOf<2>(a, c).relation, HullRelation::disjoint);
    const Points<2> d = {{0.25 * size, 0.25 * size}, {size, size}};  // a segment into a triangle
    EXPECT_EQ(planeOf<2>(a, d).relation, HullRelation::overlapping);
  }
}

TEST(SeparatingPlane, ManyPoints) {
  std::mt19937_64 random(test::testSeed(7));
  std::normal_distribution<double> normal;
  Points<3> a, b;
  for (int i = 0; i < 20'000; ++i) {
    a.push_back(Vec3(normal(random), normal(random), normal(random)).normalized());
    b.push_back(Vec3(normal(random), normal(random), normal(random)).normalized() +
                Vec3(0, 0, 2.001));
  }
  const SeparatingPlane<3> found = planeOf<3>(a, b);
  EXPECT_EQ(found.relation, HullRelation::disjoint);
  EXPECT_FALSE(found.exact);
  for (Vec3& x : b) x.z() -= 0.01;
  EXPECT_EQ(planeOf<3>(a, b).relation, HullRelation::overlapping);
}

TEST(SeparatingPlane, InvalidSetsAreRefused) {
  EXPECT_THROW(planeOf<3>({}, {Vec3::Zero()}), std::invalid_argument);
  EXPECT_THROW(planeOf<3>({Vec3::Zero()}, {}), std::invalid_argument);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(planeOf<3>({Vec3::Zero()}, {Vec3(0, nan, 0)}), std::invalid_argument);
}

}  // namespace
}  // namespace corridor
