// Tests of the shares of limits that rows use, against 113 bits: each share must be an upper bound
// of the true share, rounding included, and close to it. The truth is computed here, from the
// meaning of rows in planner/trajectory/README.md.
#include "planner/trajectory/limits_proof.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <gtest/gtest.h>

#include "planner/trajectory/rows_limits.h"
#include "tests/planner/trajectory/paths.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using Number = boost::multiprecision::cpp_bin_float_quad;
using Triple = std::array<Number, 3>;

Number lengthOf(const Triple& v) {
  return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

Triple crossOf(const Triple& a, const Triple& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

std::array<Number, 4> unitOf(const Configuration& q) {
  std::array<Number, 4> n;
  Number squares = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    n[i] = q[static_cast<Eigen::Index>(i)];
    squares += n[i] * n[i];
  }
  for (Number& x : n) x /= sqrt(squares);
  return n;
}

/// Returns the angular velocity of the slerp between two rows, rad/s, in the frame of the
/// quaternions.
Triple trueRate(const TimedRow& from, const TimedRow& to) {
  const std::array<Number, 4> a = unitOf(from.position);
  std::array<Number, 4> b = unitOf(to.position);
  Number product = 0, less = 0, more = 0;
  for (std::size_t i = 0; i < 4; ++i) product += a[i] * b[i];
  if (product < 0)
    for (Number& x : b) x = -x;
  for (std::size_t i = 0; i < 4; ++i) {
    less += (b[i] - a[i]) * (b[i] - a[i]);
    more += (b[i] + a[i]) * (b[i] + a[i]);
  }
  const Number angle = 4 * atan2(sqrt(less), sqrt(more));
  const Triple cross = crossOf({b[0], b[1], b[2]}, {a[0], a[1], a[2]});
  Triple v;
  for (std::size_t i = 0; i < 3; ++i) v[i] = a[3] * b[i] - b[3] * a[i] - cross[i];
  const Number length = lengthOf(v), duration = Number(to.time) - Number(from.time);
  for (Number& x : v) x = length == 0 ? Number(0) : Number(x * angle / length / duration);
  return v;
}

/// Returns a point, given in the coordinates of a frame with the orientation q, in the coordinates
/// before the rotation: p + 2w(v × p) + 2v × (v × p).
Triple rotated(const Configuration& q, const Eigen::Vector3d& p) {
  const std::array<Number, 4> n = unitOf(q);
  const Triple v{n[0], n[1], n[2]}, x{p[0], p[1], p[2]}, once = crossOf(v, x),
                                                         twice = crossOf(v, once);
  Triple y;
  for (std::size_t i = 0; i < 3; ++i) y[i] = x[i] + 2 * n[3] * once[i] + 2 * twice[i];
  return y;
}

ConfigurationSpace rotationSpace() {
  ConfigurationSpace space;
  space.add({Coordinate::Kind::rotation, "rotation", 0, 0, 0, true, 1});
  return space;
}

KinematicTree rotationTree() {
  Frame frame;
  frame.joint = Frame::Joint::rotation;
  frame.variable = 0;
  KinematicTree tree;
  tree.add(frame);
  return tree;
}

/// Three rows of a rotation. The turns are large, small, or equal up to rounding (as in a log of a
/// constant rate); the durations too; and the quaternions have any norm and sign.
struct RotationRows {
  std::vector<TimedRow> rows;

  explicit RotationRows(std::mt19937_64& random) {
    std::uniform_real_distribution<double> unit(-1, 1);
    std::normal_distribution<double> normal;
    const auto oneIn = [&](int n) { return std::uniform_int_distribution(0, n - 1)(random) == 0; };
    const auto power = [&](double low, double high) {
      return std::pow(10, std::uniform_real_distribution(low, high)(random));
    };
    const auto axis = [&] {
      return Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
    };
    Eigen::Quaterniond q(normal(random), normal(random), normal(random), normal(random));
    q.normalize();
    double time = oneIn(2) ? 0 : power(-3, 4), duration = power(-6, 1), angle = 0;
    Eigen::Vector3d about = axis();
    const bool steady = oneIn(3);
    for (int k = 0; k < 3; ++k) {
      const double scale = oneIn(3) ? power(-3, 3) : 1;
      const Configuration stored = q.coeffs() * (oneIn(4) ? -scale : scale);
      const Configuration none = Configuration::Zero(4);
      rows.push_back({time, stored, none, none});
      if (k == 0 || !steady) {
        angle = oneIn(3) ? 3 * unit(random) : power(-14, 0);
        about = axis();
        if (!oneIn(3)) duration = power(-6, 1);
      }
      q = (Eigen::Quaterniond(Eigen::AngleAxisd(angle, about)) * q).normalized();
      time += duration;
    }
  }

  Number duration(std::size_t i) const { return Number(rows[i + 1].time) - Number(rows[i].time); }
  /// The quotient that stands for the angular acceleration at the row in the middle.
  Number acceleration() const {
    const Triple a = trueRate(rows[0], rows[1]), b = trueRate(rows[1], rows[2]);
    return lengthOf({b[0] - a[0], b[1] - a[1], b[2] - a[2]}) / ((duration(0) + duration(1)) / 2);
  }
  /// By how much the bound of the acceleration may exceed it (limits_proof.h).
  Number accelerationRounding() const { return Number(0x1p-55) / (duration(0) * duration(1)); }
};

constexpr double kNone = std::numeric_limits<double>::infinity();

TEST(LimitsProof, SharesOfRotationsAreUpperBounds) {
  const std::uint64_t seed = test::testSeed(1);
  std::mt19937_64 random(seed);
  const ConfigurationSpace space = rotationSpace();
  const int count = (test::isStressRun() ? 100'000 : 3'000) / test::kSlowdown;
  // The largest and the mean distance of the bounds from the truth, as a share of what is allowed.
  double farthest = 0, sum = 0;
  int rounded = 0;
  for (int n = 0; n < count; ++n) {
    const RotationRows made(random);
    const int degree = n % 2 ? 3 : 5;
    const auto ratiosFor = [&](double velocity, double acceleration) {
      return proveLimits(made.rows, degree, space, test::uniformLimits(4, velocity, acceleration),
                         {});
    };
    const LimitRatios ratios = ratiosFor(0.3, 0.7);
    const Number truth = made.acceleration(), rounding = made.accelerationRounding();
    const Number bound = Number(ratios.acceleration.share) * Number(0.7);
    ASSERT_GE(bound, truth) << "case " << n;
    ASSERT_LE(bound, truth * (1 + Number(0x1p-49)) + rounding) << "case " << n;
    if (rounding > truth * Number(0x1p-40)) {
      const auto share = static_cast<double>((bound - truth) / rounding);
      farthest = std::max(farthest, share);
      sum += share;
      ++rounded;
    }
    // The verdict is right for every limit, except within the rounding.
    const auto exceeded = static_cast<double>(truth * (1 - Number(0x1p-39))),
               kept = static_cast<double>((truth + rounding) * (1 + Number(0x1p-39)));
    ASSERT_STREQ(limitsVerdict(ratiosFor(kNone, exceeded)), "exceeded") << "case " << n;
    ASSERT_STREQ(limitsVerdict(ratiosFor(kNone, kept)), "kept") << "case " << n;

    Number fastest = 0, allowed = 0;
    for (std::size_t i = 0; i < 2; ++i) {
      const Number rate = lengthOf(trueRate(made.rows[i], made.rows[i + 1]));
      fastest = std::max(fastest, rate);
      allowed = std::max<Number>(allowed,
                                 rate * (1 + Number(0x1p-49)) + Number(0x1p-56) / made.duration(i));
    }
    const Number speed = Number(ratios.velocity.share) * Number(0.3);
    ASSERT_GE(speed, fastest) << "case " << n;
    ASSERT_LE(speed, allowed) << "case " << n;
  }
  EXPECT_GT(rounded, count / 10);
  std::cout << rounded << " bounds in which the rounding counts; distance from the truth, as a "
            << "share of what is allowed: mean " << sum / rounded << ", largest " << farthest
            << "\n";
}

TEST(LimitsProof, RotationsAtRestHaveNoShare) {
  const Configuration none = Configuration::Zero(4);
  Configuration q(4);
  q << 0.1, -0.7, 0.3, 1e-3;
  const std::vector<TimedRow> rows{{0, q, none, none}, {1e-9, -q, none, none}, {2, q, none, none}};
  const LimitRatios ratios =
      proveLimits(rows, 3, rotationSpace(), test::uniformLimits(4, 1e-300, 1e-300), {});
  EXPECT_EQ(ratios.velocity.share, 0);
  EXPECT_EQ(ratios.acceleration.share, 0);
}

TEST(LimitsProof, HalfTurnsHaveNoAcceleration) {
  const Configuration none = Configuration::Zero(4);
  const auto turned = [](double angle) {
    Configuration q(4);
    q << std::sin(angle / 2), 0, 0, std::cos(angle / 2);
    return q;
  };
  for (const double missing : {0.0, 1e-10, 1e-8}) {
    const std::vector<TimedRow> rows{{0, turned(0), none, none},
                                     {1, turned(std::numbers::pi - missing), none, none},
                                     {2, turned(std::numbers::pi - missing), none, none}};
    JointLimits limits = test::uniformLimits(4, 1, 1);
    limits.links.push_back({"body", 1, 1, {Eigen::Vector3d::UnitY()}});
    const LimitRatios ratios = proveLimits(rows, 3, rotationSpace(), limits, rotationTree());
    EXPECT_NEAR(ratios.velocity.share, std::numbers::pi, 1e-7);
    EXPECT_EQ(std::isinf(ratios.link.share), missing < 1e-9);
    if (missing < 1e-9)
      EXPECT_EQ(ratios.acceleration.share, kNone);
    else
      EXPECT_NEAR(ratios.acceleration.share, std::numbers::pi, 1e-7);
  }
}

/// A point of a link that only rotates moves at |ω × r|, which is constant between two rows.
TEST(LimitsProof, LinkSpeedsOfRotationsAreUpperBounds) {
  const std::uint64_t seed = test::testSeed(2);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  const ConfigurationSpace space = rotationSpace();
  const KinematicTree tree = rotationTree();
  const int count = (test::isStressRun() ? 20'000 : 1'000) / test::kSlowdown;
  for (int n = 0; n < count; ++n) {
    const RotationRows made(random);
    const Eigen::Vector3d p(unit(random), unit(random), unit(random));
    Number fastest = 0, shortest = std::min(made.duration(0), made.duration(1));
    for (std::size_t i = 0; i < 2; ++i)
      fastest = std::max(fastest, lengthOf(crossOf(trueRate(made.rows[i], made.rows[i + 1]),
                                                   rotated(made.rows[i].position, p))));
    // With half of the speed as the limit, the bound does not stop at 1.
    const double limit = static_cast<double>(fastest / 2);
    if (limit == 0) continue;
    JointLimits limits = test::uniformLimits(4, kNone, kNone);
    limits.links.push_back({"body", 1, limit, {p}});
    const LimitRatios ratios = proveLimits(made.rows, 3, space, limits, tree);
    const Number bound = Number(ratios.link.share) * Number(limit);
    ASSERT_GE(bound, fastest) << "case " << n;
    // Some parts in a thousand, because an interval is not halved further; or the acceleration
    // after 16 halvings; or the rounding.
    ASSERT_LE(bound, fastest * Number(1.006) + Number(p.norm()) * Number(0x1p-55) / shortest)
        << "case " << n;
  }
}

/// A polynomial in τ in [0, 1], as a sum of powers.
using Powers = std::array<Number, 6>;

/// Returns the curve of one component between two rows: the polynomial of degree 1, 3 or 5 with the
/// positions, velocities and accelerations of both.
Powers trueCurve(const TimedRow& from, const TimedRow& to, int degree, Eigen::Index n) {
  const Number T = Number(to.time) - Number(from.time), p = from.position[n],
               way = Number(to.position[n]) - p, v0 = T * Number(from.velocity[n]),
               v1 = T * Number(to.velocity[n]), a0 = T * T * Number(from.acceleration[n]),
               a1 = T * T * Number(to.acceleration[n]);
  if (degree == 1) return {p, way};
  if (degree == 3) return {p, v0, 3 * way - 2 * v0 - v1, v0 + v1 - 2 * way};
  return {p,
          v0,
          a0 / 2,
          10 * way - 6 * v0 - 4 * v1 - (3 * a0 - a1) / 2,
          -15 * way + 8 * v0 + 7 * v1 + (3 * a0 - 2 * a1) / 2,
          6 * way - 3 * (v0 + v1) - (a0 - a1) / 2};
}

Powers derivativeOf(const Powers& p, const Number& duration) {
  Powers d{};
  for (std::size_t k = 1; k < p.size(); ++k) d[k - 1] = p[k] * Number(k) / duration;
  return d;
}

Number valueAt(const Powers& p, const Number& t) {
  Number sum = 0;
  for (std::size_t k = p.size(); k-- > 0;) sum = sum * t + p[k];
  return sum;
}

/// Returns the largest length of a vector of polynomials at the ends and at samples.
Number largestOf(const std::vector<Powers>& vector, int samples) {
  Number most = 0;
  for (int k = 0; k <= samples; ++k) {
    Number squares = 0;
    for (const Powers& p : vector) {
      const Number value = valueAt(p, Number(k) / samples);
      squares += value * value;
    }
    most = std::max<Number>(most, sqrt(squares));
  }
  return most;
}

/// A single joint, and a planar position of two numbers with one limit.
TEST(LimitsProof, SharesOfNumbersAreUpperBounds) {
  const std::uint64_t seed = test::testSeed(3);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1), exponent(-6, 3);
  const auto any = [&] { return unit(random) * std::pow(10, exponent(random)); };
  ConfigurationSpace space = test::jointSpace(1);
  CoordinateGroup group{CoordinateGroup::Kind::planar, "base", {}};
  for (const char* name : {"x", "y"})
    group.coordinates.push_back(space.add({Coordinate::Kind::line, name, 0, -1e9, 1e9, false, 1}));
  space.addGroup(group);
  const int count = (test::isStressRun() ? 20'000 : 300) / test::kSlowdown, samples = 100;
  int cancelled = 0;
  for (int n = 0; n < count; ++n) {
    const int degree = 1 + 2 * (n % 3);
    const double start = n % 2 ? 0 : std::abs(any());
    const auto vector = [&] { return Configuration::NullaryExpr(3, any); };
    std::vector<TimedRow> rows;
    for (const double time : {start, start + 1e-6 + std::abs(any())})
      rows.push_back({time, vector(), vector(), vector()});
    if (n % 4 < 2) {  // a log of a constant velocity: the terms of the accelerations cancel
      rows[1].velocity = rows[0].velocity;
      rows[1].position = rows[0].position + (rows[1].time - rows[0].time) * rows[0].velocity;
      for (TimedRow& row : rows) row.acceleration *= 1e-12;
    }
    const Number T = Number(rows[1].time) - Number(rows[0].time);
    for (const bool joint : {true, false}) {
      // Limits that the value exceeds: then the bound is improved as far as possible.
      JointLimits limits = test::uniformLimits(3, kNone, kNone);
      const Eigen::Index first = joint ? 0 : 1;
      limits.velocity[first] = limits.acceleration[first] = limits.jerk[first] = 1e-9;
      const LimitRatios ratios = proveLimits(rows, degree, space, limits, {});
      std::vector<Powers> curve;
      for (Eigen::Index k = first; k < (joint ? 1 : 3); ++k)
        curve.push_back(trueCurve(rows[0], rows[1], degree, k));
      // The rounding that is allowed: that of the largest terms, of which the factors are at most
      // 120 (jerk).
      Number rounding = 0;
      for (Eigen::Index k = first; k < (joint ? 1 : 3); ++k) {
        rounding += abs(Number(rows[1].position[k]) - Number(rows[0].position[k]));
        for (const TimedRow& row : rows)
          rounding += T * std::abs(row.velocity[k]) + T * T * std::abs(row.acceleration[k]);
      }
      rounding *= 120 * Number(0x1p-46);
      for (const LimitShare* share : {&ratios.velocity, &ratios.acceleration, &ratios.jerk}) {
        rounding /= T;
        for (Powers& p : curve) p = derivativeOf(p, T);
        if (share != &ratios.velocity && degree == 1) break;  // bends count as infinite
        if (share == &ratios.jerk && degree == 3) break;      // jumps at rows
        const Number most = largestOf(curve, samples), bound = Number(share->share) * Number(1e-9);
        ASSERT_GE(bound, most) << "case " << n;
        // The samples are near the maximum, and the bound is within 0.01 % of a value.
        ASSERT_LE(bound, most * Number(1.002) + rounding) << "case " << n;
        cancelled += most < rounding;
      }
    }
  }
  EXPECT_GT(cancelled, count / 4);
}

}  // namespace
}  // namespace corridor
