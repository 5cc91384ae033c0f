#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/planner/trajectory/paths.h"
#include "tests/support/support.h"

namespace corridor::test {
namespace {

/// Returns the shortest time through one piece, from rest to rest, by dynamic programming in the
/// phase plane: for each of `n` values of τ, `levels` values of x = ṡ² up to the limit of velocity.
/// A step between two values is allowed if the accelerations in the middle of the step are within
/// their limits.
double shortestTime(const CurvePiece& path, double velocity, double acceleration, int n,
                    int levels) {
  const double width = 1.0 / n, infinity = std::numeric_limits<double>::infinity();
  const auto derivatives = [&](double tau) {
    // A law of constant rate 1 has q̇ = q′ and q̈ = q″.
    TimeLaw unit;
    unit.segments = {{0, 1, 0, 0, 1, 0, 0}};
    return sampleAt(unit, {path}, tau);
  };
  const auto mostAt = [&](int i) {
    const Configuration v = derivatives(i * width).v.cwiseAbs();
    double most = std::pow(velocity / v.maxCoeff(), 2);
    // From rest to rest over a length of at most L, a joint reaches at most sqrt(a·L).
    for (Eigen::Index j = 0; j < v.size(); ++j) {
      double length = 0;
      for (Eigen::Index k = 0; k + 1 < path.coefficients.cols(); ++k)
        length += std::abs(path.coefficients(j, k + 1) - path.coefficients(j, k));
      most = std::min(most, acceleration * length / (v[j] * v[j]));
    }
    return most;
  };
  std::vector<double> next(static_cast<std::size_t>(levels) + 1, infinity), now = next;
  next[0] = 0;
  std::vector<double> root(next.size());  // of the next values of x
  double mostNext = mostAt(n);
  for (int i = n - 1; i >= 0; --i) {
    const double most = mostAt(i);
    for (std::size_t m = 0; m < root.size(); ++m)
      root[m] = std::sqrt(mostNext * static_cast<double>(m) / levels);
    const Sample middle = derivatives((i + 0.5) * width);
    for (int k = 0; k <= levels; ++k) {
      const double x = most * k / levels, rootX = std::sqrt(x);
      // |q′·(y − x)/(2·width) + q″·(x + y)/2| ≤ a bounds y for each joint.
      double low = 0, high = mostNext;
      for (Eigen::Index j = 0; j < middle.v.size(); ++j) {
        const double byY = middle.v[j] / (2 * width) + middle.a[j] / 2,
                     rest = x * (middle.a[j] / 2 - middle.v[j] / (2 * width));
        const double a = (-acceleration - rest) / byY, b = (acceleration - rest) / byY;
        low = std::max(low, std::min(a, b));
        high = std::min(high, std::max(a, b));
      }
      double best = infinity;
      for (int m = static_cast<int>(std::ceil(low / mostNext * levels));
           m <= levels && mostNext * m / levels <= high; ++m)
        if (const auto to = static_cast<std::size_t>(m); rootX + root[to] > 0)
          best = std::min(best, next[to] + 2 * width / (rootX + root[to]));
      now[static_cast<std::size_t>(k)] = best;
    }
    std::swap(now, next);
    mostNext = most;
  }
  return next[0];
}

TEST(Optimum, ProgrammingFindsATriangle) {
  EXPECT_NEAR(shortestTime(piece({{0, 1}}), 9, 1, 100, 1500), 2, 0.01);
}

TEST(Optimum, IsFoundOnRandomCurves) {
  const unsigned seed = 20180731;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> value(-1, 1);
  const int curves = test::casesOf(7, 20);
  for (int i = 0; i < curves; ++i) {
    const std::size_t joints = 1 + static_cast<std::size_t>(i) % 3 + 1;
    const std::size_t degree = 2 + static_cast<std::size_t>(i) % 4;
    std::vector<std::vector<double>> rows(joints, std::vector<double>(degree + 1));
    for (auto& row : rows)
      for (double& c : row) c = value(random);
    for (std::size_t k = 0; k <= degree; ++k) rows[0][k] += 0.7 * static_cast<double>(k);
    const double velocity = i % 2 == 0 ? 1 : 2.5, acceleration = 2;
    const CurvePiece path = piece(rows);
    const TimeLaw law =
        timeLaw({path}, jointSpace(joints), uniformLimits(joints, velocity, acceleration), {});
    ASSERT_EQ(law.fault, "");
    const double best = shortestTime(path, velocity, acceleration, 100, 1500);
    EXPECT_NEAR(law.duration, best, 0.01 * best) << "seed " << seed << ", curve " << i;
  }
}

}  // namespace
}  // namespace corridor::test
