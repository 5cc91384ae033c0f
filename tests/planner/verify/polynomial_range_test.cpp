// Tests of polynomials in Bernstein form, and of their limits: against rational arithmetic and
// Sturm sequences.
#include "planner/verify/polynomial_range.h"

#include <cmath>
#include <random>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>
#include <gtest/gtest.h>

#include "tests/support/polynomial.h"
#include "tests/support/support.h"

namespace corridor::verify {
namespace {

using Rational = boost::multiprecision::cpp_rational;
using test::Integer;
using Verdict = RangeAnswer::Verdict;

Rational binomial(int n, int k) {
  Rational product = 1;
  for (int i = 1; i <= k; ++i) product = product * (n - k + i) / i;
  return product;
}

/// Returns the coefficients of the polynomial Σ B_i(t)·d_i in the power basis.
std::vector<Rational> powerSeries(const std::vector<Rational>& d) {
  const int n = static_cast<int>(d.size()) - 1;
  std::vector<Rational> series;
  for (int j = 0; j <= n; ++j) {
    Rational sum = 0;
    for (int i = 0; i <= j; ++i)
      sum += ((i + j) % 2 ? -1 : 1) * binomial(j, i) * d[static_cast<std::size_t>(i)];
    series.push_back(binomial(n, j) * sum);
  }
  return series;
}

/// Returns the polynomial times a positive number that makes all coefficients integers.
test::Polynomial inIntegers(const std::vector<Rational>& series) {
  boost::multiprecision::cpp_int common = 1;
  for (const Rational& each : series) common = lcm(common, denominator(each));
  std::vector<Integer> coefficients;
  for (const Rational& each : series)
    coefficients.emplace_back(numerator(each) * (common / denominator(each)));
  while (!coefficients.empty() && coefficients.back() == 0) coefficients.pop_back();
  return test::Polynomial(coefficients);
}

/// Returns the sign of the polynomial's largest value on [0, 1].
int signOfLargest(const std::vector<Rational>& d) {
  const test::Polynomial p = inIntegers(powerSeries(d));
  if (p.isZero()) return 0;
  int sign = std::max(p.signAt(0, 0), p.signAt(1, 0));
  const test::Polynomial slope = p.derivative();
  if (slope.isZero()) return sign;
  for (test::Root& root : test::rootsInUnitInterval(slope)) sign = std::max(sign, root.signOf(p));
  return sign;
}

Rational valueAt(const std::vector<Rational>& d, const Rational& t) {
  const std::vector<Rational> series = powerSeries(d);
  Rational value = 0;
  for (std::size_t j = series.size(); j-- > 0;) value = value * t + series[j];
  return value;
}

/// Compares an answer with the exact one. @param d the exact coefficients. @returns whether the
/// answer is a decision.
bool check(const RangeAnswer& answer, const std::vector<Rational>& d, const Rational& lower,
           const Rational& upper) {
  std::vector<Rational> above = d, below = d;
  for (Rational& each : above) each -= upper;
  for (Rational& each : below) each = lower - each;
  const int most = std::max(signOfLargest(above), signOfLargest(below));
  if (answer.verdict == Verdict::within) {
    EXPECT_LE(most, 0);
  }
  if (answer.verdict == Verdict::exceeded) {
    EXPECT_GT(most, 0);
    const Rational value = valueAt(d, Rational(answer.at));
    EXPECT_TRUE(value > upper || value < lower);
  }
  return answer.verdict != Verdict::undecided;
}

std::vector<Rational> exact(const std::vector<double>& d) {
  return {d.begin(), d.end()};
}

/// With whole numbers as coefficients, ties are likely: the polynomial touches its limit, or starts
/// or ends at the limit.
TEST(PolynomialRange, AgreesWithSturmOnWholeNumbers) {
  std::mt19937_64 random(test::testSeed(20));
  int undecided = 0, within = 0, exceeded = 0;
  for (int i = 0; i < 500; ++i) {
    const int degree = 1 + i % 9;
    std::uniform_int_distribution<int> whole(-4, 4);
    std::vector<double> d;
    for (int k = 0; k <= degree; ++k) d.push_back(whole(random));
    const int upper = std::uniform_int_distribution<int>(1, 4)(random), lower = -4 + i % 3;
    const RangeAnswer answer = rangeOf(Bernstein(d), lower, upper);
    undecided += !check(answer, exact(d), lower, upper);
    within += answer.verdict == Verdict::within;
    exceeded += answer.verdict == Verdict::exceeded;
  }
  EXPECT_GT(within, 100);
  EXPECT_GT(exceeded, 100);
  EXPECT_LT(undecided, 5) << "only limits that are touched at a time which is no double";
}

/// The limit is set at the polynomial's largest value, and then displaced.
TEST(PolynomialRange, DecidesAllButTheRounding) {
  std::mt19937_64 random(test::testSeed(21));
  std::uniform_real_distribution<double> uniform(-1, 1);
  const int count = test::casesOf(28, 48);
  for (int i = 0; i < count; ++i) {
    const int degree = 2 + i % 8;
    // In a third of the cases the coefficients are large and partly cancel.
    const double scale = i % 3 == 0 ? 1e6 : 1;
    std::vector<double> d;
    for (int k = 0; k <= degree; ++k)
      d.push_back(k == 0 || k == degree ? 0
                                        : (k % 2 ? scale : -scale) * (1 + 0.1 * uniform(random)));
    Real most = -1;
    for (int k = 0; k <= 4000; ++k) most = std::max(most, Bernstein(d).at(k / 4000.0L));
    for (const double away : {1e-3, 1e-6, 1e-9, 1e-12, 1e-14}) {
      const auto far = static_cast<double>(most) + 1e-5 * scale + away;
      const RangeAnswer inside = rangeOf(Bernstein(d), -2 * scale, far);
      EXPECT_EQ(inside.verdict, Verdict::within);
      check(inside, exact(d), -2 * Rational(scale), Rational(far));
      for (const double sign : {-1.0, 1.0}) {
        const double near = static_cast<double>(most) + sign * away * scale;
        const RangeAnswer answer = rangeOf(Bernstein(d), -2 * scale, near);
        EXPECT_TRUE(check(answer, exact(d), -2 * Rational(scale), Rational(near)));
        if (sign < 0) {
          EXPECT_EQ(answer.verdict, Verdict::exceeded) << away;
        }
      }
    }
  }
}

TEST(PolynomialRange, LimitsAreInclusive) {
  // 4τ(1 − τ) reaches 1 at τ = 1/2.
  const Bernstein hill(std::vector<double>{0, 2, 0});
  EXPECT_EQ(rangeOf(hill, 0, 1).verdict, Verdict::within);
  const RangeAnswer above = rangeOf(hill, 0, 1 - 0x1p-50L);
  EXPECT_EQ(above.verdict, Verdict::exceeded);
  EXPECT_NEAR(static_cast<double>(above.at), 0.5, 1e-7);
  EXPECT_EQ(rangeOf(hill, 0x1p-1074L, 1).verdict, Verdict::exceeded);
  EXPECT_EQ(rangeOf(hill, 0x1p-1074L, 1).at, 0);
  // An end of the polynomial is at a limit whose double has no zeros at the end.
  const double limit = 2.8973;
  EXPECT_EQ(rangeOf(Bernstein(std::vector<double>{0.1, 1, limit, limit}), -limit, limit).verdict,
            Verdict::within);
  const double more = std::nextafter(limit, 9);
  EXPECT_EQ(rangeOf(Bernstein(std::vector<double>{0.1, 1, limit, more}), -limit, limit).verdict,
            Verdict::exceeded);
  // The limit is touched at τ = 1/3, where (1 − τ)²τ·27/4 is 1. No bisection meets this τ.
  EXPECT_EQ(rangeOf(Bernstein(std::vector<double>{0, 2.25, 0, 0}), 0, 1).verdict,
            Verdict::undecided);
  EXPECT_EQ(rangeOf(Bernstein(std::vector<double>{0, 2.25, 0, 0}), 0, 1 + 0x1p-55L).verdict,
            Verdict::within);
  const Real infinity = std::numeric_limits<Real>::infinity();
  EXPECT_EQ(rangeOf(hill, -infinity, infinity).verdict, Verdict::within);
  EXPECT_EQ(rangeOf(hill, -infinity, 0.75L).verdict, Verdict::exceeded);
  EXPECT_EQ(rangeOf(Bernstein(std::vector<double>{3}), 3, 3).verdict, Verdict::within);
}

/// An error of the coefficients widens the range of limits for which there is no verdict, by the
/// same amount at both ends.
TEST(PolynomialRange, AnErrorCountsOnBothSides) {
  Bernstein hill(std::vector<double>{0, 2, 0});
  hill.error = 0x1p-10L;
  EXPECT_EQ(rangeOf(hill, -1, 1 + 0x1.01p-10L).verdict, Verdict::within);
  EXPECT_EQ(rangeOf(hill, -1, 1 + 0x1p-11L).verdict, Verdict::undecided);
  EXPECT_EQ(rangeOf(hill, -1, 1 - 0x1p-11L).verdict, Verdict::undecided);
  EXPECT_EQ(rangeOf(hill, -1, 1 - 0x1.01p-10L).verdict, Verdict::exceeded);
}

/// Limits of speed are limits of the derivative by time, for a duration that is not a power of two
/// and is rounded.
TEST(PolynomialRange, LimitsOfDerivatives) {
  std::mt19937_64 random(test::testSeed(22));
  std::uniform_real_distribution<double> uniform(-1, 1);
  int within = 0, exceeded = 0;
  for (int i = 0; i < 150; ++i) {
    const int degree = 1 + i % 9;
    std::vector<double> d;
    for (int k = 0; k <= degree; ++k) d.push_back(uniform(random));
    const double from = 1e3 * uniform(random), to = from + 1.5 + uniform(random);
    const Real length = Real(to) - Real(from);
    Bernstein rate(d);
    std::vector<Rational> truth = exact(d);
    const int times = 1 + i % 2;
    for (int k = 0; k < times; ++k) {
      rate = derivativeOf(rate, length, 0x1p-63L * length);
      const auto n = static_cast<int>(truth.size()) - 1;
      for (int j = 0; j < n; ++j)
        truth[std::size_t(j)] = n * (truth[std::size_t(j) + 1] - truth[std::size_t(j)]) /
                                (Rational(to) - Rational(from));
      truth.resize(std::max<std::size_t>(truth.size() - 1, 1));
      if (n == 0) truth = {0};
    }
    ASSERT_EQ(rate.coefficients().size(), truth.size());
    for (std::size_t k = 0; k < truth.size(); ++k) {
      EXPECT_LE(abs(Rational(rate.c[k]) - truth[k]), Rational(rate.error));
      EXPECT_LE(rate.error, 0x1p-52L);
    }
    Real most = 0;
    for (int k = 0; k <= 500; ++k) most = std::max(most, rate.at(k / 500.0L));
    for (const double away : {1e-2, 1e-6, 1e-12}) {
      const double limit = static_cast<double>(most) + (i % 4 < 2 ? -away : away + 0.02);
      const RangeAnswer answer = rangeOf(rate, -1000, limit);
      EXPECT_TRUE(check(answer, truth, -1000, Rational(limit))) << i;
      within += answer.verdict == Verdict::within;
      exceeded += answer.verdict == Verdict::exceeded;
    }
  }
  EXPECT_GT(within, 100);
  EXPECT_GT(exceeded, 100);
  // A straight piece exactly at its limit.
  const Bernstein line = derivativeOf(Bernstein(std::vector<double>{0, 1.5, 3}), 2);
  EXPECT_EQ(line.error, 0);
  EXPECT_EQ(rangeOf(line, -1.5L, 1.5L).verdict, Verdict::within);
}

TEST(Bernstein, HalvesAndValuesAreWithinTheirErrors) {
  std::mt19937_64 random(test::testSeed(23));
  std::uniform_real_distribution<double> uniform(-1, 1);
  Rational worstValue = 0;
  for (int i = 0; i < 300; ++i) {
    const int degree = i % 10;
    std::vector<double> d;
    for (int k = 0; k <= degree; ++k) d.push_back(uniform(random) * std::pow(10.0, i % 7));
    Bernstein part(d);
    Rational start = 0, width = 1;
    for (int depth = 0; depth < 12; ++depth) {
      const bool right = random() % 2 == 0;
      part = halvesOf(part)[right ? 1 : 0];
      width /= 2;
      if (right) start += width;
      for (const Real t : {0.0L, 0.25L, 1.0L}) {
        const Rational truth = valueAt(exact(d), start + width * Rational(t));
        const Rational off = abs(Rational(part.at(t)) - truth);
        EXPECT_LE(off, Rational(part.error) + Rational(19 * 0x1p-64L * part.largest()));
        if (t == 0) {
          EXPECT_LE(abs(Rational(part.c[0]) - truth), Rational(part.error));
        }
        EXPECT_LE(abs(truth), Rational(part.largest()));
      }
    }
    EXPECT_LE(part.error, 12 * 9 * 0x1p-64L * Bernstein(d).largest());
    const Real t = static_cast<Real>(random() % (1u << 30)) / (1u << 30);
    const Rational off = abs(Rational(Bernstein(d).at(t)) - valueAt(exact(d), Rational(t)));
    EXPECT_LE(off, Rational(19 * 0x1p-64L * Bernstein(d).largest()));
    worstValue = std::max(worstValue, Rational(off / Rational(0x1p-64L * Bernstein(d).largest())));
  }
  EXPECT_GT(worstValue, Rational(1) / 4) << "the bound is not measured by this test";
}

}  // namespace
}  // namespace corridor::verify
