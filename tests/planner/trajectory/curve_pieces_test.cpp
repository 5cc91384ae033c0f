// Tests of conversions to Bernstein form. The oracle is rational arithmetic on the given doubles.
// The stand-in for a controller is the evaluation of ros_control's trajectory controllers, written
// from its formula.
#include "planner/trajectory/curve_pieces.h"

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include <boost/multiprecision/cpp_int.hpp>
#include <gtest/gtest.h>

#include "tests/support/support.h"

namespace corridor {
namespace {

using Rational = boost::multiprecision::cpp_rational;

ConfigurationSpace lineSpace(Coordinate::Kind kind = Coordinate::Kind::line) {
  ConfigurationSpace space;
  Coordinate c;
  c.kind = kind;
  c.name = "pan";
  c.angular = true;
  space.addGroup({CoordinateGroup::Kind::joints, "", {space.add(c)}});
  return space;
}

Configuration one(double value) {
  return Configuration::Constant(1, value);
}

/// Returns the value of a piece's polynomial at τ, exactly (de Casteljau).
Rational valueOf(const CurvePiece& piece, const Rational& tau, Eigen::Index row = 0) {
  std::vector<Rational> c;
  for (const double value : piece.coefficients.row(row)) c.emplace_back(value);
  for (std::size_t last = c.size() - 1; last > 0; --last)
    for (std::size_t i = 0; i < last; ++i) c[i] = c[i] * (1 - tau) + c[i + 1] * tau;
  return c.front();
}

/// Expects that a value is within the error of a piece. `worst` becomes the largest share of it.
void expectWithin(const CurvePiece& piece, const Rational& tau, const Rational& value,
                  double& worst, const std::string& what) {
  const Rational off = abs(valueOf(piece, tau) - value), error(piece.error[0]);
  EXPECT_LE(off, error) << what << ": " << double(off) << " > " << double(error);
  worst = std::max(worst, double(off / error));
}

struct Hermite {
  double p0, p1, v0, v1, a0, a1, T;
};

/// Returns a random case; many have values of very different sizes, or values that cancel.
Hermite randomCase(std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(-1, 1), exponent(-12, 6);
  const auto any = [&] { return unit(random) * std::pow(10, exponent(random)); };
  Hermite h{3 * unit(random), 3 * unit(random), any(), any(), any(), any(), std::abs(any()) + 1e-9};
  if (unit(random) > 0.5) h.p1 = h.p0 + h.T * h.v0;
  if (unit(random) > 0.5) h.v1 = -h.v0;
  return h;
}

/// The polynomial with these positions, velocities and accelerations in power form: it solves the
/// six equations, exactly.
Rational quinticAt(const Hermite& h, const Rational& tau) {
  const Rational p0(h.p0), p1(h.p1), T(h.T), v0 = T * Rational(h.v0), v1 = T * Rational(h.v1),
                                             a0 = T * T * Rational(h.a0),
                                             a1 = T * T * Rational(h.a1);
  const Rational d = p1 - p0, t2 = tau * tau, t3 = t2 * tau;
  return p0 + v0 * tau + a0 / 2 * t2 + (10 * d - 6 * v0 - 4 * v1 - (3 * a0 - a1) / 2) * t3 +
         (-15 * d + 8 * v0 + 7 * v1 + (3 * a0 - 2 * a1) / 2) * t3 * tau +
         (6 * d - 3 * (v0 + v1) - (a0 - a1) / 2) * t3 * t2;
}

Rational cubicAt(const Hermite& h, const Rational& tau) {
  const Rational p0(h.p0), p1(h.p1), T(h.T), v0 = T * Rational(h.v0), v1 = T * Rational(h.v1);
  const Rational d = p1 - p0;
  return p0 + v0 * tau + (3 * d - 2 * v0 - v1) * tau * tau + (v0 + v1 - 2 * d) * tau * tau * tau;
}

/// Evaluates as trajectory_interface::QuinticSplineSegment does, in doubles.
double controllerQuintic(const Hermite& h, double t) {
  std::array<double, 6> T{1}, s{1};
  for (std::size_t k = 1; k < 6; ++k) T[k] = T[k - 1] * h.T, s[k] = s[k - 1] * t;
  const std::array<double, 6> c{
      h.p0,
      h.v0,
      0.5 * h.a0,
      (-20 * h.p0 + 20 * h.p1 - 3 * h.a0 * T[2] + h.a1 * T[2] - 12 * h.v0 * T[1] -
       8 * h.v1 * T[1]) /
          (2 * T[3]),
      (30 * h.p0 - 30 * h.p1 + 3 * h.a0 * T[2] - 2 * h.a1 * T[2] + 16 * h.v0 * T[1] +
       14 * h.v1 * T[1]) /
          (2 * T[4]),
      (-12 * h.p0 + 12 * h.p1 - h.a0 * T[2] + h.a1 * T[2] - 6 * h.v0 * T[1] - 6 * h.v1 * T[1]) /
          (2 * T[5])};
  return s[0] * c[0] + s[1] * c[1] + s[2] * c[2] + s[3] * c[3] + s[4] * c[4] + s[5] * c[5];
}

double controllerCubic(const Hermite& h, double t) {
  const double T2 = h.T * h.T, T3 = T2 * h.T, t2 = t * t, t3 = t2 * t;
  const double c2 = (-3 * h.p0 + 3 * h.p1 - 2 * h.v0 * h.T - h.v1 * h.T) / T2,
               c3 = (2 * h.p0 - 2 * h.p1 + h.v0 * h.T + h.v1 * h.T) / T3;
  return h.p0 + t * h.v0 + t2 * c2 + t3 * c3;
}

TEST(CurvePieces, HermitePiecesAreWithinTheirError) {
  const std::uint64_t seed = test::testSeed(1);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  const ConfigurationSpace space = lineSpace();
  double worst[3] = {}, controller[3] = {}, duration[2] = {};
  for (int i = 0; i < 400; ++i) {
    const Hermite h = randomCase(random);
    const CurvePoint from{one(h.p0), one(h.v0), one(h.a0)}, to{one(h.p1), one(h.v1), one(h.a1)};
    const CurvePiece linear = linearPiece(space, one(h.p0), one(h.p1));
    const CurvePiece cubic = cubicPiece(space, from, to, h.T);
    const CurvePiece quintic = quinticPiece(space, from, to, h.T);
    for (const CurvePiece* piece : {&linear, &cubic, &quintic}) {  // the ends are exact
      EXPECT_EQ(piece->coefficients(0, 0), h.p0);
      EXPECT_EQ(piece->coefficients(0, piece->degree()), h.p1);
    }
    const double t = unit(random) * h.T;
    const Rational tau = Rational(t) / Rational(h.T);
    const std::string what = "case " + std::to_string(i);
    const Rational line = Rational(h.p0) + tau * (Rational(h.p1) - Rational(h.p0));
    EXPECT_EQ(valueOf(linear, tau), line);
    expectWithin(cubic, tau, cubicAt(h, tau), worst[1], what);
    expectWithin(quintic, tau, quinticAt(h, tau), worst[2], what);
    expectWithin(linear, tau, Rational(h.p0 + t * ((h.p1 - h.p0) / h.T)), controller[0], what);
    expectWithin(cubic, tau, Rational(controllerCubic(h, t)), controller[1], what);
    expectWithin(quintic, tau, Rational(controllerQuintic(h, t)), controller[2], what);
    // A controller whose duration is off.
    const double off = 1e-3 * h.T;
    Hermite longer = h;
    longer.T += off;
    expectWithin(cubicPiece(space, from, to, h.T, off), tau, cubicAt(longer, tau), duration[0],
                 what);
    expectWithin(quinticPiece(space, from, to, h.T, off), tau, quinticAt(longer, tau), duration[1],
                 what);
  }
  // The bounds are not far too large: a controller reaches a part of them.
  for (const double share : controller) EXPECT_GT(share, 1.0 / 500);
  for (const double share : duration) EXPECT_GT(share, 1.0 / 500);
  std::cout << "largest share of the error, conversion: cubic " << worst[1] << ", quintic "
            << worst[2] << "; controller: linear " << controller[0] << ", cubic " << controller[1]
            << ", quintic " << controller[2] << "; duration: " << duration[0] << ", " << duration[1]
            << "\n";
}

TEST(CurvePieces, PowerSeriesOfEveryDegree) {
  const std::uint64_t seed = test::testSeed(2);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1), exponent(-3, 3);
  double worst = 0;
  for (Eigen::Index n = 1; n <= CurvePiece::kLargestDegree; ++n)
    for (int i = 0; i < 60; ++i) {
      const double T = std::pow(10, exponent(random)), t = std::abs(unit(random)) * T;
      Eigen::MatrixXd a(1, n + 1);
      for (Eigen::Index k = 0; k <= n; ++k)
        a(0, k) = unit(random) * std::pow(10, exponent(random)) / std::pow(T, k);
      const CurvePiece piece = powerPiece(a, T);
      Rational exact = 0;
      double horner = 0;
      for (Eigen::Index k = n; k >= 0; --k)
        exact = exact * Rational(t) + Rational(a(0, k)), horner = horner * t + a(0, k);
      const Rational tau = Rational(t) / Rational(T);
      expectWithin(piece, tau, exact, worst, "degree " + std::to_string(n));
      expectWithin(piece, tau, Rational(horner), worst, "Horner, degree " + std::to_string(n));
    }
  EXPECT_GT(worst, 0);
  EXPECT_THROW(powerPiece(Eigen::MatrixXd::Zero(1, 1), 1), std::invalid_argument);
  EXPECT_THROW(powerPiece(Eigen::MatrixXd::Zero(1, 11), 1), std::invalid_argument);
}

/// Returns N_{i,p}(t) by the recursion of Cox and de Boor: it shares no step with the polar form.
Rational basis(const std::vector<double>& u, std::size_t i, int p, const Rational& t) {
  if (p == 0) return Rational(u[i]) <= t && t < Rational(u[i + 1]) ? 1 : 0;
  const auto q = static_cast<std::size_t>(p);
  Rational sum = 0;
  if (u[i + q] > u[i])
    sum += (t - Rational(u[i])) / (Rational(u[i + q]) - Rational(u[i])) * basis(u, i, p - 1, t);
  if (u[i + q + 1] > u[i + 1])
    sum += (Rational(u[i + q + 1]) - t) / (Rational(u[i + q + 1]) - Rational(u[i + 1])) *
           basis(u, i + 1, p - 1, t);
  return sum;
}

TEST(CurvePieces, SplinesAgreeWithTheirBasis) {
  const std::uint64_t seed = test::testSeed(3);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  double worst = 0;
  for (int degree = 1; degree <= 5; ++degree)
    for (const bool clamped : {true, false})
      for (const bool repeated : {true, false}) {
        const std::size_t count = static_cast<std::size_t>(degree) + 4;
        std::vector<double> knots;
        for (std::size_t i = 0; i < count + static_cast<std::size_t>(degree) + 1; ++i)
          knots.push_back((i ? knots.back() : -1) + 0.1 + unit(random));
        const auto p = static_cast<std::size_t>(degree);
        for (std::size_t i = 0; clamped && i < p; ++i)
          knots[i] = knots[p], knots[count + 1 + i] = knots[count];
        if (repeated) knots[p + 2] = knots[p + 1];
        Eigen::MatrixXd points(1, static_cast<Eigen::Index>(count));
        for (double& value : points.reshaped()) value = 10 * unit(random) - 5;
        const Curve curve = splineCurve(points, knots, degree);
        ASSERT_EQ(curve.pieces.size(), repeated ? 3u : 4u);
        ASSERT_EQ(curve.knots.size(), curve.pieces.size() + 1);
        EXPECT_EQ(curve.knots.front(), knots[p]);
        EXPECT_EQ(curve.knots.back(), knots[count]);
        for (std::size_t k = 0; k < curve.pieces.size(); ++k) {
          const Rational begin(curve.knots[k]), end(curve.knots[k + 1]), tau(unit(random));
          const Rational t = begin + tau * (end - begin);
          Rational value = 0;
          for (std::size_t i = 0; i < count; ++i)
            value += Rational(points(0, static_cast<Eigen::Index>(i))) * basis(knots, i, degree, t);
          expectWithin(curve.pieces[k], tau, value, worst, "degree " + std::to_string(degree));
        }
      }
  EXPECT_THROW(splineCurve(Eigen::MatrixXd::Zero(1, 4), {0, 1, 2}, 3), std::invalid_argument);
  EXPECT_THROW(splineCurve(Eigen::MatrixXd::Zero(1, 2), {0, 0, 1, 0.5}, 1), std::invalid_argument);
}

TEST(CurvePieces, RotationsAreSlerps) {
  ConfigurationSpace space;
  space.addGroup({CoordinateGroup::Kind::floating, "", {}});
  Coordinate c;
  c.kind = Coordinate::Kind::rotation;
  space.add(c);
  Configuration from(4), to(4);
  from << 0, 0, 0, 1;
  to << 0.5, 0.5, 0.5, 0.7;
  const Configuration zero = Configuration::Zero(4);
  for (const CurvePiece& piece :
       {linearPiece(space, from, to), cubicPiece(space, {from, zero, zero}, {to, zero, zero}, 1),
        quinticPiece(space, {from, zero, zero}, {to, zero, zero}, 1)}) {
    EXPECT_EQ(piece.coefficients.col(0), from);
    EXPECT_EQ(piece.coefficients.col(piece.degree()), to);
    EXPECT_EQ(piece.error[0], 0x1p-44);  // of a controller that evaluates the slerp in doubles
    EXPECT_TRUE(piece.error.tail(3).isZero(0));
  }
}

TEST(CurvePieces, EdgesGoTheShorterWayWithoutJumps) {
  constexpr double pi = std::numbers::pi;
  const ConfigurationSpace space = lineSpace(Coordinate::Kind::circle);
  const std::vector<double> angles{3, -3, -1, 1, 3, -2.5, 2.5, 100, -100};
  std::vector<Configuration> states;
  for (const double angle : angles) states.push_back(one(angle));
  const Curve curve = curveOfPath(space, states);
  ASSERT_EQ(curve.pieces.size(), angles.size() - 1);
  for (std::size_t k = 0; k < curve.pieces.size(); ++k) {
    const CurvePiece& piece = curve.pieces[k];
    const double begin = piece.coefficients(0, 0), end = piece.coefficients(0, 1);
    EXPECT_LE(std::abs(end - begin), pi);
    if (k > 0) {
      EXPECT_EQ(begin, curve.pieces[k - 1].coefficients(0, 1));
    }
    for (const auto& [value, angle] : {std::pair{begin, angles[k]}, {end, angles[k + 1]}}) {
      const long double turns = (value - static_cast<long double>(angle)) / (2 * pi);
      EXPECT_LE(std::abs(turns - std::round(turns)) * 2 * pi, piece.error[0] + 0x1p-52 * 16);
    }
  }
  EXPECT_EQ(curve.pieces[0].coefficients(0, 0), 3);
  EXPECT_NEAR(curve.pieces[0].coefficients(0, 1), 2 * pi - 3, 1e-15);
  EXPECT_EQ(curve.knots.back(), 8);
  EXPECT_THROW(curveOfPath(space, {one(0), one(pi)}), std::invalid_argument);
  EXPECT_THROW(curveOfPath(space, {one(0)}), std::invalid_argument);
}

}  // namespace
}  // namespace corridor
