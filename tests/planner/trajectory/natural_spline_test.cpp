// Tests of natural splines: closed forms, the conditions that define them, and states inserted by
// trial.
#include "planner/trajectory/natural_spline.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "planner/trajectory/curve_pieces.h"
#include "tests/planner/trajectory/paths.h"

namespace corridor {
namespace {

Configuration number(double x) {
  return Configuration::Constant(1, x);
}

/// Returns the first or second derivative by the parameter of chord lengths, at an end of a piece.
Configuration derivative(const CurvePiece& piece, double chord, int order, bool atEnd) {
  const Eigen::MatrixXd& c = piece.coefficients;
  if (order == 1) return 3 / chord * (atEnd ? c.col(3) - c.col(2) : c.col(1) - c.col(0));
  return 6 / (chord * chord) *
         (atEnd ? c.col(3) - 2 * c.col(2) + c.col(1) : c.col(2) - 2 * c.col(1) + c.col(0));
}

/// Through 0, 1, 0 at chord lengths of 1, the second derivative in the middle is −3. So the spline
/// is at 1/2 + 3/16 in the middle of each piece.
TEST(NaturalSpline, ClosedForm) {
  const auto pieces = naturalSpline({number(0), number(1), number(0)});
  ASSERT_EQ(pieces.size(), 2u);
  const ConfigurationSpace space = test::jointSpace(1);
  for (const CurvePiece& piece : pieces)
    EXPECT_NEAR(configurationAt(space, piece, 0.5)[0], 0.6875, 1e-15);
  const auto line = naturalSpline({number(-2), number(4)});
  ASSERT_EQ(line.size(), 1u);
  for (int i = 0; i <= 3; ++i) EXPECT_NEAR(line[0].coefficients(0, i), -2 + 2 * i, 1e-14);
}

/// These conditions determine a natural spline: it passes through the states, its first and second
/// derivatives are continuous, and the second derivative is 0 at both ends.
TEST(NaturalSpline, MeetsTheConditionsThatDefineIt) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> value(-3, 3);
  for (int round = 0; round < 100; ++round) {
    std::vector<Configuration> q(2 + static_cast<std::size_t>(round) % 9);
    for (Configuration& state : q)
      state = Configuration::NullaryExpr(4, [&] { return value(random); });
    const auto pieces = naturalSpline(q);
    ASSERT_EQ(pieces.size(), q.size() - 1);
    std::vector<double> h;
    double bend = 0;  // the largest second derivative, as the scale of errors
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      h.push_back((q[i + 1] - q[i]).norm());
      bend = std::max(bend, derivative(pieces[i], h[i], 2, true).norm());
      EXPECT_EQ(pieces[i].coefficients.col(0), q[i]);
      EXPECT_EQ(pieces[i].coefficients.col(3), q[i + 1]);
    }
    // Rounding: coefficients of up to some 10, divided by h², in a system whose inverse has the
    // norm 1/h at most.
    for (std::size_t i = 0; i + 1 < pieces.size(); ++i) {
      const double tolerance = 1e-12 * (1 + bend) / (h[i] * h[i + 1]);
      for (const int order : {1, 2})
        EXPECT_LT((derivative(pieces[i], h[i], order, true) -
                   derivative(pieces[i + 1], h[i + 1], order, false))
                      .norm(),
                  tolerance);
    }
    const double tolerance = 1e-12 * (1 + bend) / (h.front() * h.front() + h.back() * h.back());
    EXPECT_LT(derivative(pieces.front(), h.front(), 2, false).norm(),
              tolerance + 1e-12 / h.front());
    EXPECT_LT(derivative(pieces.back(), h.back(), 2, true).norm(), tolerance + 1e-12 / h.back());
  }
}

TEST(NaturalSpline, RepeatedStatesAreLeftOut) {
  const ConfigurationSpace space = test::jointSpace(1);
  const std::vector<Configuration> path{number(0), number(1), number(1), number(2)};
  const auto states = statesOfLines(curveOfPath(space, path).pieces);
  ASSERT_EQ(states.size(), 3u);
  EXPECT_EQ(states[1][0], 1);
  EXPECT_EQ(states[2][0], 2);
}

/// A corner at (1, 0), and a wall at y < −0.05 below the first edge. The spline dips into it.
class InsertedStates : public testing::Test {
 protected:
  static Configuration at(double x, double y) {
    Configuration q(2);
    q << x, y;
    return q;
  }
  const ConfigurationSpace space_ = test::jointSpace(2);
  const std::vector<Configuration> states_{at(0, 0), at(1, 0), at(1, 1)};
};

TEST_F(InsertedStates, UntilNoSampleTouches) {
  const auto touches = [](const Configuration& q) { return q[1] < -0.05; };
  const auto dips = [&](const std::vector<CurvePiece>& pieces) {
    for (const CurvePiece& piece : pieces)
      for (int i = 0; i <= 1000; ++i)
        if (touches(configurationAt(space_, piece, i / 1000.0))) return true;
    return false;
  };
  ASSERT_TRUE(dips(naturalSpline(states_)));
  const InsertedSpline spline = insertedSpline(space_, states_, touches);
  EXPECT_GT(spline.inserted, 0u);
  EXPECT_LT(spline.inserted, 20u);
  EXPECT_FALSE(spline.touches);
  EXPECT_EQ(spline.pieces.size(), states_.size() - 1 + spline.inserted);
  EXPECT_FALSE(dips(spline.pieces));
  // Inserted states are on the path.
  for (const CurvePiece& piece : spline.pieces) {
    const auto q = piece.coefficients.col(0);
    EXPECT_TRUE(q[1] == 0 || q[0] == 1) << q.transpose();
  }
  const InsertedSpline as = insertedSpline(space_, states_, [](const auto&) { return false; });
  EXPECT_EQ(as.inserted, 0u);
  EXPECT_EQ(as.pieces.size(), 2u);
}

TEST_F(InsertedStates, AtMostAsManyAsAllowed) {
  std::size_t samples = 0;
  const InsertedSpline spline = insertedSpline(
      space_, states_, [&](const Configuration&) { return ++samples, true; }, 0.05, 7);
  EXPECT_EQ(spline.inserted, 7u);
  EXPECT_TRUE(spline.touches);
  EXPECT_EQ(samples, 8u);  // the first sample of each spline touches
}

/// Adjacent samples are at most `step` apart.
TEST_F(InsertedStates, SamplesAreDense) {
  std::vector<Configuration> samples;
  insertedSpline(
      space_, states_, [&](const Configuration& q) { return samples.push_back(q), false; }, 0.01);
  ASSERT_GT(samples.size(), 200u);  // two pieces that are longer than 1
  for (std::size_t i = 1; i < samples.size(); ++i)
    EXPECT_LE((samples[i] - samples[i - 1]).norm(), 0.01 + 1e-12);
}

}  // namespace
}  // namespace corridor
