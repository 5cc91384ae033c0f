#include "planner/trajectory/emit.h"

#include <cmath>

#include <Eigen/LU>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/planner/trajectory/paths.h"

namespace corridor::test {
namespace {

const KinematicTree kNoTree;

/// The largest shares of limits, and the largest distance from the law's path, at samples of the
/// rows' curve. Hermite's polynomials are solved for by linear equations in the power basis.
struct Sampled {
  double velocity = 0, acceleration = 0, jerk = 0, distance = 0;
};
Sampled sampled(const Emission& emission, int degree, const JointLimits& limits) {
  Sampled most;
  for (std::size_t i = 0; i + 1 < emission.rows.size(); ++i) {
    const TimedRow &a = emission.rows[i], &b = emission.rows[i + 1];
    const double T = b.time - a.time;
    const int n = degree + 1, half = n / 2;
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n), values(n, a.position.size());
    const auto power = [](double t, int k, int derived) {
      double factor = 1;
      for (int m = 0; m < derived; ++m) factor *= k - m;
      return k < derived ? 0.0 : factor * std::pow(t, k - derived);
    };
    const Configuration* of[] = {&a.position, &a.velocity, &a.acceleration,
                                 &b.position, &b.velocity, &b.acceleration};
    for (int d = 0; d < half; ++d)
      for (int k = 0; k < n; ++k) {
        matrix(d, k) = power(0, k, d);
        matrix(half + d, k) = power(1, k, d);
        values.row(d) = of[d]->transpose() * std::pow(T, d);
        values.row(half + d) = of[3 + d]->transpose() * std::pow(T, d);
      }
    const Eigen::MatrixXd c = matrix.fullPivLu().solve(values);
    for (int s = 0; s <= 20; ++s)
      for (int d = 1; d <= half; ++d) {
        Configuration at = Configuration::Zero(a.position.size());
        for (int k = 0; k < n; ++k) at += c.row(k).transpose() * power(s / 20.0, k, d);
        at /= std::pow(T, d);
        const Configuration* limit[] = {&limits.velocity, &limits.acceleration, &limits.jerk};
        double Sampled::*kinds[] = {&Sampled::velocity, &Sampled::acceleration, &Sampled::jerk};
        double& share = most.*kinds[d - 1];
        share = std::max(share, at.cwiseAbs().cwiseQuotient(*limit[d - 1]).maxCoeff());
      }
  }
  return most;
}

void expectKept(const Emission& emission, int degree, const JointLimits& limits) {
  ASSERT_EQ(emission.fault, "");
  const Sampled most = sampled(emission, degree, limits);
  // 1e-6: the rounding of the linear equations above, for rows as near as 10^-5 s.
  EXPECT_LE(most.velocity, emission.ratios.velocity.share + 1e-6);
  EXPECT_LE(most.acceleration, emission.ratios.acceleration.share + 1e-6);
  EXPECT_GE(most.velocity, emission.ratios.velocity.share * 0.99);
  EXPECT_GE(most.acceleration, emission.ratios.acceleration.share * 0.99);
  EXPECT_LE(emission.ratios.velocity.share, 1);
  EXPECT_LE(emission.ratios.acceleration.share, 1);
  if (degree == 5) {
    EXPECT_LE(most.jerk, emission.ratios.jerk.share + 1e-4);
    EXPECT_LE(emission.ratios.jerk.share, 1);
  }
}

class Splines : public testing::Test {
 protected:
  Splines() : path_(randomSpline(7, 20, random_)) {}
  std::mt19937 random_{11};
  std::vector<CurvePiece> path_;
  ConfigurationSpace space_ = jointSpace(7);
  JointLimits limits_ = uniformLimits(7, 2, 5, 60);
};

TEST_F(Splines, CubicRowsKeepLimits) {
  const TimeLaw law = timeLaw(path_, space_, limits_, kNoTree);
  ASSERT_EQ(law.fault, "");
  const Emission emission = emitRows(law, path_, space_, limits_, kNoTree, {.deviation = 1e-4});
  expectKept(emission, 3, limits_);
  EXPECT_LE(emission.deviation, 1e-4);
  EXPECT_LE(emission.stretch, 1.01);
  EXPECT_NEAR(emission.duration, law.duration * emission.stretch, 1e-9);
  EXPECT_EQ(emission.rows.front().position, path_.front().coefficients.col(0));
  EXPECT_EQ(emission.rows.back().position, path_.back().coefficients.col(3));
  EXPECT_EQ(emission.rows.front().velocity.norm() + emission.rows.back().velocity.norm(), 0);
}

TEST_F(Splines, SmoothQuinticRowsKeepJerk) {
  const TimeLaw law = timeLaw(path_, space_, limits_, kNoTree, {.smooth = true});
  ASSERT_EQ(law.fault, "");
  const Emission emission =
      emitRows(law, path_, space_, limits_, kNoTree, {.degree = 5, .deviation = 1e-3});
  expectKept(emission, 5, limits_);
  EXPECT_GE(emission.duration, timeLaw(path_, space_, limits_, kNoTree).duration);
}

TEST_F(Splines, RowsAtARate) {
  const TimeLaw law = timeLaw(path_, space_, limits_, kNoTree);
  const Emission emission =
      emitRows(law, path_, space_, limits_, kNoTree, {.rate = 50, .deviation = 1e-3});
  expectKept(emission, 3, limits_);
  std::size_t regular = 0;
  for (const TimedRow& row : emission.rows) {
    const double periods = row.time * 50;
    if (std::abs(periods - std::round(periods)) < 1e-6) ++regular;
  }
  EXPECT_EQ(emission.rows.size(), regular + emission.extraRows);
  EXPECT_EQ(regular, std::lround(emission.duration * 50) + 1);
}

TEST_F(Splines, RatesAtTheEndsAreKept) {
  TimeLawOptions options;
  options.startRate = 0.2;
  options.endRate = 0.1;
  const TimeLaw law = timeLaw(path_, space_, limits_, kNoTree, options);
  ASSERT_EQ(law.fault, "");
  const Emission emission = emitRows(law, path_, space_, limits_, kNoTree, {.deviation = 1e-3});
  expectKept(emission, 3, limits_);
  const Eigen::MatrixXd& c = path_.front().coefficients;
  EXPECT_LT((emission.rows.front().velocity - 0.2 * 3 * (c.col(1) - c.col(0))).norm(), 1e-12);
}

TEST(EmitRows, StopsAtCornersOfAPolyline) {
  const std::vector<CurvePiece> path{piece({{0, 1}, {0, 0}}), piece({{1, 1}, {0, 2}})};
  const JointLimits limits = uniformLimits(2, 1, 2);
  const TimeLaw law = timeLaw(path, jointSpace(2), limits, kNoTree);
  for (const std::optional<double> rate : {std::optional<double>(), std::optional<double>(100)}) {
    const Emission emission =
        emitRows(law, path, jointSpace(2), limits, kNoTree, {.rate = rate, .deviation = 1e-9});
    expectKept(emission, 3, limits);
    const bool stops =
        std::any_of(emission.rows.begin(), emission.rows.end(), [](const TimedRow& row) {
          return row.position == Configuration(Eigen::Vector2d(1, 0)) &&
                 row.velocity.norm() < 1e-12;
        });
    EXPECT_TRUE(stops);
    EXPECT_NEAR(emission.duration, law.duration, rate ? 0.03 : 1e-6);
    EXPECT_LT(emission.rows.size(), rate ? 420 : 10);
  }
}

TEST(EmitRows, ShortPiecesDoNotSlowDownTheRest) {
  // A corner of 10^-6 between lines of 1 rad: intervals of its size are 10^-6 of the run.
  const double s = 1e-6, h = s / 2;
  const std::vector<CurvePiece> path{piece({{0, 1 - s}, {0, 0}}),
                                     piece({{1 - s, 1 - h, 1, 1, 1, 1}, {0, 0, 0, 0, h, s}}),
                                     piece({{1, 1}, {s, 1}})};
  const JointLimits limits = uniformLimits(2, 1, 2);
  const TimeLaw law = timeLaw(path, jointSpace(2), limits, kNoTree);
  EXPECT_TRUE(law.stopTimes.empty());
  const Emission emission = emitRows(law, path, jointSpace(2), limits, kNoTree);
  expectKept(emission, 3, limits);
  EXPECT_LE(emission.stretch, 1.005);
  EXPECT_LE(emission.duration, 1.001 * 2 * 1.5);  // as long as with a stop at the corner, 3 s
}

TEST(EmitRows, RotationsKeepTheirRate) {
  ConfigurationSpace space;
  CoordinateGroup group{CoordinateGroup::Kind::floating, "body", {}};
  for (const char* name : {"x", "y", "z"})
    group.coordinates.push_back(space.add({Coordinate::Kind::line, name, 0, -9, 9, false, 1}));
  group.coordinates.push_back(
      space.add({Coordinate::Kind::rotation, "rotation", 0, 0, 0, true, 1}));
  space.addGroup(group);
  const double half = 0.6;  // half of the rotation angle
  const std::vector<CurvePiece> path{
      piece({{0, 3}, {0, 4}, {0, 0}, {0, std::sin(half)}, {0, 0}, {0, 0}, {1, std::cos(half)}})};
  JointLimits limits = uniformLimits(7, std::numeric_limits<double>::infinity(), 2);
  limits.velocity[3] = 0.25;
  const TimeLaw law = timeLaw(path, space, limits, kNoTree);
  ASSERT_EQ(law.fault, "");
  // The rotation by 1.2 rad is limited to 0.25 rad/s. The way of 5 m is limited to 2 m/s², so s̈ ≤
  // 0.4; the limit by the rotation, 2/1.2, is larger.
  const double v = 0.25 / 1.2, a = 2 / 5.0;
  EXPECT_NEAR(law.duration, 1 / v + v / a, 1e-9);
  const Emission emission = emitRows(law, path, space, limits, kNoTree, {.deviation = 1e-3});
  ASSERT_EQ(emission.fault, "");
  EXPECT_LE(emission.ratios.velocity.share, 1);
  EXPECT_LE(emission.ratios.acceleration.share, 1);
  EXPECT_EQ(emission.ratios.velocity.number, 3);
}

TEST(EmitRows, LinkSpeed) {
  // A link of 2 m on a revolute joint: its tip may move at 0.25 m/s, so the joint at 0.125 rad/s.
  KinematicTree tree;
  Frame frame;
  frame.joint = Frame::Joint::revolute;
  frame.variable = 0;
  tree.add(frame);
  JointLimits limits = uniformLimits(1, 3, 5);
  limits.links.push_back({"arm", 1, 0.25, {Eigen::Vector3d::Zero(), Eigen::Vector3d(2, 0, 0)}});
  const std::vector<CurvePiece> path{piece({{0, 0.1, 0.7, 1}})};
  const TimeLaw law = timeLaw(path, jointSpace(1), limits, tree);
  EXPECT_NEAR(law.duration, 1 / 0.125 + 0.125 / 5, 0.02);
  const Emission emission = emitRows(law, path, jointSpace(1), limits, tree, {.deviation = 1e-3});
  ASSERT_EQ(emission.fault, "");
  EXPECT_LE(emission.ratios.link.share, 1);
  EXPECT_GE(emission.ratios.link.share, 0.98);
  EXPECT_LE(emission.duration, 1.02 * law.duration);
  double fastest = 0;
  for (const TimedRow& row : emission.rows) fastest = std::max(fastest, std::abs(row.velocity[0]));
  EXPECT_LE(2 * fastest, 0.25);
}

TEST(EmitRows, Faults) {
  const std::vector<CurvePiece> path{piece({{0, 1}})};
  const JointLimits limits = uniformLimits(1, 1, 1);
  const auto faultOf = [&](const EmitOptions& options) {
    return emitRows(timeLaw(path, jointSpace(1), limits, kNoTree), path, jointSpace(1), limits,
                    kNoTree, options)
        .fault;
  };
  EXPECT_EQ(faultOf({.degree = 4}), "trajectory: the degree must be 3 or 5, not 4");
  EXPECT_EQ(faultOf({.rate = 0}), "trajectory: the rate must be positive");
  EXPECT_EQ(faultOf({.rate = 1e9}), "trajectory: more than 10^6 rows; use a smaller rate");
  EXPECT_EQ(faultOf({.deviation = 0}), "trajectory: the deviation must be positive");
  EXPECT_EQ(emitRows({}, {}, jointSpace(1), limits, kNoTree).fault,
            "trajectory: the path is empty");
  const std::vector<CurvePiece> point{piece({{2, 2}})};
  EXPECT_EQ(emitRows(timeLaw(point, jointSpace(1), limits, kNoTree), point, jointSpace(1), limits,
                     kNoTree)
                .rows.size(),
            1);
}

}  // namespace
}  // namespace corridor::test
