#include "collision/course/linear_program.h"

#include <array>
#include <cmath>
#include <iostream>
#include <limits>
#include <random>
#include <span>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/rational_program.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

template <int D>
using Vector = Eigen::Matrix<double, D, 1>;

/// Returns the status of the program, by the rational simplex method and duality. The sums run over
/// all half-spaces i.
/// * Infeasible: Σ w_i normal_i = 0, Σ w_i offset_i = −1 has a solution w ≥ 0.
/// * Bounded: Σ w_i normal_i = goal has a solution w ≥ 0. (`goal` is the vector of the objective.)
template <int D>
LinearProgramStatus statusOf(const std::vector<HalfSpace<D>>& list, const Vector<D>& goal) {
  std::vector<std::vector<double>> normals;
  std::vector<double> right(goal.data(), goal.data() + D);
  for (const auto& each : list) normals.emplace_back(each.normal.data(), each.normal.data() + D);
  const bool bounded = test::hasSolution(normals, right);
  for (std::size_t i = 0; i < list.size(); ++i) normals[i].push_back(list[i].offset);
  right.assign(D + 1, 0.0);
  right[D] = -1;
  if (test::hasSolution(normals, right)) return LinearProgramStatus::infeasible;
  return bounded ? LinearProgramStatus::optimal : LinearProgramStatus::unbounded;
}

template <int D>
class Programs {
 public:
  explicit Programs(std::uint64_t seed) : random_(seed) {}

  /// Returns random half-spaces. Their coefficients are real numbers or small integers. Some
  /// normals are repeated or opposite. Some half-spaces contain the origin, others don't.
  std::vector<HalfSpace<D>> next() {
    const bool whole = random_() % 2;
    const std::size_t count = random_() % (D < 4 ? 9 : 4 * D);
    const double least = random_() % 3 ? -0.3 : -1;
    std::vector<HalfSpace<D>> list;
    for (std::size_t i = 0; i < count; ++i) {
      HalfSpace<D> each{vector(whole), whole ? static_cast<double>(random_() % 7) - 2
                                             : std::uniform_real_distribution(least, 1.0)(random_)};
      if (i > 0 && random_() % 4 == 0) {
        each = list[random_() % i];
        if (random_() % 2) each.normal = -each.normal, each.offset = -each.offset;
      }
      list.push_back(each);
    }
    return list;
  }
  Vector<D> goal() { return random_() % 5 ? vector(random_() % 2) : Vector<D>(Vector<D>::Zero()); }

 private:
  Vector<D> vector(bool whole) {
    return Vector<D>::NullaryExpr([&] {
      return whole ? static_cast<double>(random_() % 5) - 2
                   : std::uniform_real_distribution(-1.0, 1.0)(random_);
    });
  }
  std::mt19937_64 random_;
};

template <int D>
void compare(int count, std::uint64_t seed) {
  Programs<D> programs(seed);
  std::array<int, 3> seen{};
  int exact = 0;
  for (int n = 0; n < count; ++n) {
    const std::vector<HalfSpace<D>> list = programs.next();
    const Vector<D> goal = programs.goal();
    const auto found = solveLinearProgram<D>(list, goal, static_cast<std::uint64_t>(n));
    ASSERT_EQ(found.status, statusOf<D>(list, goal)) << "program " << n;
    ++seen[static_cast<std::size_t>(found.status)];
    exact += found.exact;
    const double size = 1 + found.x.cwiseAbs().maxCoeff();
    if (found.status != LinearProgramStatus::infeasible) {
      for (const auto& each : list)
        EXPECT_LE(each.normal.dot(found.x) - each.offset, 1e-15 * 8 * size) << "program " << n;
    }
    if (found.status == LinearProgramStatus::unbounded) {
      EXPECT_GT(goal.dot(found.ray), 0) << "program " << n;
      for (const auto& each : list) EXPECT_LE(each.normal.dot(found.ray), 1e-15) << "program " << n;
      continue;
    }
    Vector<D> sum = Vector<D>::Zero();
    double offsets = 0, weights = 0;
    for (const auto& [i, weight] : found.proof) {
      EXPECT_GT(weight, 0);
      sum += weight * list.at(i).normal;
      offsets += weight * list[i].offset;
      weights += weight;
    }
    if (found.status == LinearProgramStatus::infeasible) {
      EXPECT_LE(found.proof.size(), D + 1u);
      EXPECT_LT(sum.norm(), 1e-13 * weights) << "program " << n;
      EXPECT_LT(offsets, 0) << "program " << n;
    } else {
      EXPECT_LE(found.proof.size(), static_cast<std::size_t>(D));
      EXPECT_LT((sum - goal).norm(), 1e-13 * (1 + weights)) << "program " << n;
      // Duality: the bound that the proof gives for the objective equals the objective at x.
      EXPECT_NEAR(offsets, goal.dot(found.x), 1e-13 * (1 + weights) * size) << "program " << n;
    }
  }
  std::cout << "optimal " << seen[0] << ", unbounded " << seen[1] << ", infeasible " << seen[2]
            << "; decided in rationals: " << exact << "\n";
  for (const int each : seen) EXPECT_GT(each, count / 20);
}

int cases() {
  return test::casesOf(3'000, 100'000);
}

TEST(LinearProgram, AgreesWithRationalSimplexInSpace) {
  compare<3>(cases(), test::testSeed(3));
}
TEST(LinearProgram, AgreesWithRationalSimplexInThePlane) {
  compare<2>(cases(), test::testSeed(4));
}
TEST(LinearProgram, AgreesWithRationalSimplexInFourToSixVariables) {
  compare<4>(cases() / 50, test::testSeed(5));
  compare<5>(cases() / 50, test::testSeed(6));
  compare<6>(cases() / 50, test::testSeed(7));
}

// The dual of a cube: the maximum of goal·x over |x_1| + … + |x_6| ≤ 1 is the largest |goal_k|. All
// 64 half-spaces have a corner in common with many others.
TEST(LinearProgram, CrossPolytopeInSixVariables) {
  std::vector<HalfSpace<6>> list;
  for (unsigned signs = 0; signs < 64; ++signs) {
    HalfSpace<6> each{{}, 1};
    for (int k = 0; k < 6; ++k) each.normal[k] = signs >> k & 1 ? 1 : -1;
    list.push_back(each);
  }
  const auto found = solveLinearProgram<6>(list, Vector<6>(1, -2, 3, -4.5, 4, 0.5));
  EXPECT_EQ(found.status, LinearProgramStatus::optimal);
  EXPECT_TRUE(found.x == -Vector<6>::Unit(3)) << found.x.transpose();
}

TEST(LinearProgram, TouchingHalfSpacesShareAPoint) {
  const std::vector<HalfSpace<3>> wall = {{{1, 2, 3}, 0.1}};
  std::vector<HalfSpace<3>> back = {{{-1, -2, -3}, -0.1}};
  const auto touching = commonPoint<3>(wall, back);
  EXPECT_EQ(touching.status, LinearProgramStatus::optimal);
  EXPECT_TRUE(touching.exact);
  back[0].offset = std::nextafter(-0.1, -1);
  const auto apart = commonPoint<3>(wall, back);
  EXPECT_EQ(apart.status, LinearProgramStatus::infeasible);
  ASSERT_EQ(apart.proof.size(), 2u);
  EXPECT_DOUBLE_EQ(apart.proof[0].weight, apart.proof[1].weight);
}

TEST(LinearProgram, CommonPointOfTwoBoxesIsInside) {
  std::vector<HalfSpace<3>> a, b;
  for (int k = 0; k < 3; ++k)
    for (const double s : {-1.0, 1.0}) {
      a.push_back({s * Vec3::Unit(k), 1});
      b.push_back({s * Vec3::Unit(k), 1 + s * 1.9});
    }
  const auto found = commonPoint<3>(a, b);
  EXPECT_EQ(found.status, LinearProgramStatus::optimal);
  EXPECT_FALSE(found.exact);
  for (int k = 0; k < 3; ++k) {
    EXPECT_GT(found.x[k], 0.9);
    EXPECT_LT(found.x[k], 1);
  }
}

TEST(LinearProgram, FarAndTinyOptimaAreFound) {
  for (const double size : {1e-200, 1e-9, 1e150}) {
    const std::vector<HalfSpace<2>> corner = {{{1, 0}, size}, {{0.5, 1}, 3 * size}};
    const auto found = solveLinearProgram<2>(corner, {1, 1});
    EXPECT_EQ(found.status, LinearProgramStatus::optimal);
    EXPECT_DOUBLE_EQ(found.x[0], size);
    EXPECT_DOUBLE_EQ(found.x[1], 2.5 * size);
  }
  // Nearly parallel lines, which meet far away.
  const std::vector<HalfSpace<2>> lines = {{{1, 0x1p-40}, 1}, {{-1, 0x1p-40}, 1}};
  const auto far = solveLinearProgram<2>(lines, {0, 1});
  EXPECT_EQ(far.status, LinearProgramStatus::optimal);
  EXPECT_EQ(far.x, Eigen::Vector2d(0, 0x1p40));
}

TEST(LinearProgram, NoHalfSpacesAndEmptyNormals) {
  EXPECT_EQ(solveLinearProgram<3>({}, Vec3::Zero()).status, LinearProgramStatus::optimal);
  EXPECT_EQ(solveLinearProgram<3>({}, Vec3::UnitX()).status, LinearProgramStatus::unbounded);
  const std::vector<HalfSpace<3>> none = {{Vec3::Zero(), -1}}, all = {{Vec3::Zero(), 0}};
  EXPECT_EQ(solveLinearProgram<3>(none, Vec3::Zero()).status, LinearProgramStatus::infeasible);
  EXPECT_EQ(solveLinearProgram<3>(all, Vec3::Zero()).status, LinearProgramStatus::optimal);
}

TEST(LinearProgram, ManyHalfSpaces) {
  std::mt19937_64 random(test::testSeed(8));
  std::normal_distribution<double> normal;
  std::vector<HalfSpace<3>> ball;
  for (int i = 0; i < 50'000; ++i)
    ball.push_back({Vec3(normal(random), normal(random), normal(random)).normalized(), 1});
  const auto found = solveLinearProgram<3>(ball, {1, 2, 3});
  EXPECT_EQ(found.status, LinearProgramStatus::optimal);
  EXPECT_NEAR(found.x.norm(), 1, 1e-3);
  EXPECT_EQ(found.proof.size(), 3u);
}

TEST(LinearProgram, NumbersThatAreNotFiniteAreRefused) {
  const double inf = std::numeric_limits<double>::infinity();
  const std::vector<HalfSpace<2>> list = {{{1, 0}, inf}};
  EXPECT_THROW(solveLinearProgram<2>(list, {0, 0}), std::invalid_argument);
  EXPECT_THROW(solveLinearProgram<2>({}, {inf, 0}), std::invalid_argument);
}

}  // namespace
}  // namespace corridor
