#include "collision/motion/relative_motion.h"

#include <algorithm>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "collision/core/rounding.h"
#include "tests/support/chain_motion.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::ChainMotion;
using Vec3L = ChainMotion::Vec3L;
using Random = std::mt19937_64;

double real(Random& random, double low = -1, double high = 1) {
  return std::uniform_real_distribution(low, high)(random);
}
Vec3 vector(Random& random) {
  return Vec3(real(random), real(random), real(random));
}

/// All data, at the middle of an interval, on which a motion bound depends; and the point and
/// direction for which the bound is evaluated.
struct Trial {
  struct Joint {
    ScrewMotion::Kind kind;
    Vec3 axis, point;
    double amount;         // signed
    double tube;           // ≥ 0
    double strays;         // perturbation of the motion, in [−1, 1], relative to the tube
    double deviation = 0;  // ≥ 0
    double deviates = 0;   // deviation from uniform motion, in [−1, 1], relative to `deviation`
    Vec3 about;            // pivot rotations: the axis of the perturbation
  };
  std::vector<Joint> joints;
  Vec3 center, origin, offset, direction;  // offset: of unit length
  double radius, s;
};

struct Ratios {
  double isotropic = 0, beyond = 0, pad = 0, all = 0;
};

/// Returns the displacements of the point, computed in long double, divided by the bounds of
/// `motionBound`.
Ratios ratios(const Trial& trial) {
  RelativeMotion w;
  std::vector<ScrewMotion> screws;
  w.X_AB.t = trial.origin;
  for (const Trial::Joint& joint : trial.joints) {
    const Vec3 axis = joint.axis.normalized();
    screws.push_back({.kind = joint.kind,
                      .axis = axis,
                      .point = joint.point,
                      .amount = std::abs(joint.amount),
                      .tube = joint.tube,
                      .deviation = joint.deviation});
    if (joint.kind == ScrewMotion::Kind::prismatic) w.linear += joint.amount * axis;
    if (joint.kind != ScrewMotion::Kind::revolute) continue;
    w.linear += joint.amount * axis.cross(trial.origin - joint.point);
    w.angular += joint.amount * axis;
  }
  w.screws = screws;
  w.speed = roundedUp(w.linear.norm());
  w.angle = roundedUp(w.angular.norm());
  w.fixedError = w.reachError = 0x1p-48;  // differences between doubles and long doubles

  const Vec3 x = trial.center + trial.radius * trial.offset;
  const auto place = [&](long double s, long double share) {
    Vec3L p = x.cast<long double>();
    for (std::size_t j = trial.joints.size(); j-- > 0;) {
      const Trial::Joint& joint = trial.joints[j];
      const Vec3L axis = joint.axis.cast<long double>().normalized(),
                  point = joint.point.cast<long double>();
      const long double stray = share * joint.strays * joint.tube;
      const long double value = s * joint.amount + s * s * joint.deviates * joint.deviation + stray;
      if (joint.kind == ScrewMotion::Kind::prismatic) {
        p += axis * value;
      } else if (joint.kind == ScrewMotion::Kind::revolute) {
        p = point + ChainMotion::turn(axis, value) * (p - point);
      } else {
        p = point +
            ChainMotion::turn(joint.about.cast<long double>().normalized(), stray) * (p - point);
      }
    }
    return p;
  };
  const MotionBound bound = motionBound(w, trial.center, trial.radius);
  const Vec3L start = x.cast<long double>(), nominal = place(trial.s, 0), real = place(trial.s, 1);
  const Vec3L n = trial.direction.cast<long double>().normalized();
  const Vec3L first = (w.linear + w.angular.cross(x - trial.origin)).cast<long double>();
  const double secondOrderAcross =
      bound.secondOrderAcross * static_cast<double>(n.cross(w.angular.cast<long double>()).norm()) +
      bound.secondOrder;
  // Returns the ratio only for lengths that rounding does not dominate.
  const auto ratio = [](long double is, double allowed) {
    return allowed > 1e-9 ? static_cast<double>(is) / allowed : 0;
  };
  // The chain in long double differs by this much from the doubles of the relative motion; `pad`
  // covers it.
  const double statedError = w.fixedError + w.reachError * (x - trial.origin).norm();
  Ratios r;
  r.isotropic = ratio((nominal - start).norm() - statedError, bound.isotropic);
  r.beyond =
      ratio(std::abs(n.dot(nominal - start - trial.s * first)) - statedError, secondOrderAcross);
  r.pad = ratio((place(0, 1) - start).norm(), bound.pad);
  r.all = std::max(ratio((real - start).norm(), bound.isotropic + bound.pad),
                   ratio(std::abs(n.dot(real - start)),
                         std::min(bound.isotropic,
                                  static_cast<double>(std::abs(n.dot(first))) + secondOrderAcross) +
                             bound.pad));
  return r;
}

/// Returns a random chain. The chains are of many kinds: parallel, equal and intersecting axes,
/// translations before and after rotations, rotations above π, pivot rotations, joints that do not
/// move.
Trial start(Random& random, int n) {
  Trial trial;
  const int count = 1 + n % 5;
  const double size = std::pow(10.0, -real(random, 0, 4));  // size of the amounts
  for (int j = 0; j < count; ++j) {
    Trial::Joint joint;
    const double kind = real(random, 0, 1);
    joint.kind = kind < 0.6   ? ScrewMotion::Kind::revolute
                 : kind < 0.9 ? ScrewMotion::Kind::prismatic
                              : ScrewMotion::Kind::spherical;
    joint.axis = vector(random), joint.point = 2 * vector(random), joint.about = vector(random);
    if (j > 0 && n % 3 == 0) joint.axis = trial.joints[0].axis;
    if (j > 0 && n % 4 == 0) joint.point = trial.joints[0].point;
    joint.amount = real(random) * (n % 7 ? size : 7);
    if (joint.kind == ScrewMotion::Kind::spherical || real(random) > 0.7) joint.amount = 0;
    joint.tube = n % 2 ? 0 : real(random, 0, 0.1) * size;
    joint.strays = real(random);
    if (n % 5 == 2 && joint.kind != ScrewMotion::Kind::spherical)
      joint.deviation = real(random, 0, 0.3) * size, joint.deviates = real(random);
    trial.joints.push_back(joint);
  }
  trial.center = 2 * vector(random), trial.origin = vector(random);
  trial.offset = vector(random).normalized(), trial.direction = vector(random);
  trial.radius = n % 5 ? real(random, 0, 0.5) : 0, trial.s = real(random);
  return trial;
}

Trial perturbed(Random& random, Trial trial, double step) {
  const auto some = [&] { return real(random, 0, 1) < 0.5; };
  for (Trial::Joint& joint : trial.joints) {
    if (some()) joint.axis += step * vector(random);
    if (some()) joint.point += step * vector(random);
    if (some()) joint.amount *= 1 + step * real(random);
    if (some()) joint.tube *= 1 + step * real(random);
    if (some()) joint.strays = std::clamp(joint.strays + step * real(random), -1.0, 1.0);
    if (some()) joint.deviation *= 1 + step * real(random);
    if (some()) joint.deviates = std::clamp(joint.deviates + step * real(random), -1.0, 1.0);
    if (some()) joint.about += step * vector(random);
  }
  if (some()) trial.center += step * vector(random);
  if (some()) trial.origin += step * vector(random);
  if (some()) trial.direction = trial.direction.normalized() + step * vector(random);
  if (some()) trial.offset = (trial.offset + step * vector(random)).normalized();
  if (some()) trial.s = std::clamp(trial.s + step * real(random), -1.0, 1.0);
  return trial;
}

/// Adversarial search: hill climbing for the chain whose displacement is the largest fraction of
/// each bound. This fraction must never exceed 1, and the search must find a chain whose fraction
/// is close to 1.
TEST(MotionBounds, IsNeverExceededAndAttained) {
  Random random(test::testSeed(21));
  const int starts = test::isStressRun() ? 5000 : 300;
  double Ratios::*const goals[] = {&Ratios::isotropic, &Ratios::beyond, &Ratios::pad, &Ratios::all};
  double best[4] = {};
  long evaluations = 0;
  for (int n = 0; n < starts; ++n) {
    const int goal = n / 4 % 4;
    Trial trial = start(random, n);
    double here = ratios(trial).*goals[goal];
    for (int i = 0; i < 400; ++i, ++evaluations) {
      const Trial next = perturbed(random, trial, 0.5 * std::pow(0.98, i));
      const Ratios found = ratios(next);
      for (int k = 0; k < 4; ++k) {
        ASSERT_LE(found.*goals[k], 1) << "start " << n << ", step " << i << ", bound " << k;
        best[k] = std::max(best[k], found.*goals[k]);
      }
      if (found.*goals[goal] < here) continue;
      here = found.*goals[goal];
      trial = next;
    }
  }
  std::cout << evaluations << " chains; attained: isotropic " << best[0] << ", beyond first order "
            << best[1] << ", tube " << best[2] << ", all " << best[3] << "\n";
  for (const double share : best) EXPECT_GT(share, 0.995);
}

/// Tests that random chains of many joints do not exceed the bounds. Prints the median ratio of
/// displacement to bound.
TEST(MotionBounds, RandomChains) {
  Random random(test::testSeed(22));
  const int count = test::isStressRun() ? 10'000'000 : 50'000;
  std::vector<double> shares;  // ratios for the first chains
  for (int n = 0; n < count; ++n) {
    Trial trial = start(random, n);
    while (static_cast<int>(trial.joints.size()) < n % 12)
      for (const Trial::Joint& joint : start(random, n).joints) trial.joints.push_back(joint);
    if (n % 2) trial.s = n % 4 == 1 ? 1 : -1;
    const Ratios r = ratios(trial);
    for (const double share : {r.isotropic, r.beyond, r.pad, r.all}) ASSERT_LE(share, 1) << n;
    if (n < 50'000) shares.push_back(r.all);
  }
  const auto middle = shares.begin() + static_cast<std::ptrdiff_t>(shares.size() / 2);
  std::nth_element(shares.begin(), middle, shares.end());
  std::cout << "median share of the bound: " << *middle << "\n";
}

RelativeMotion relativeMotionOf(std::span<const ScrewMotion> screws, const Vec3& linear,
                                const Vec3& angular) {
  RelativeMotion w;
  w.screws = screws;
  w.linear = linear, w.angular = angular;
  w.speed = linear.norm(), w.angle = angular.norm();
  return w;
}

TEST(MotionBounds, OneTurn) {
  using Kind = ScrewMotion::Kind;
  const double pi = std::numbers::pi;
  for (const double amount : {1e-3, 0.5, 1.0, 2.0, 2.9, 3.0, pi, 4.0, 7.0, 100.0}) {
    const ScrewMotion turn{Kind::revolute, Vec3::UnitZ(), Vec3(1, 2, 3), amount, 0};
    const Vec3 axis = amount * Vec3::UnitZ();
    const RelativeMotion w = relativeMotionOf({&turn, 1}, axis.cross(-turn.point), axis);
    const MotionBound bound = motionBound(w, Vec3(1, 5, 8), 0.25);
    const double chord = 3.25 * 2 * std::sin(std::min(amount, pi) / 2);
    EXPECT_GE(bound.isotropic, chord);
    EXPECT_LE(bound.isotropic, 1.006 * chord);
    EXPECT_NEAR(bound.secondOrderAcross, 0.5 * 3.25 * amount, 1e-12 * amount);
    EXPECT_LE(bound.secondOrder, 1e-14 * amount * amount);
    EXPECT_LE(bound.pad, 1e-13);
  }
}

/// `angular` is rounded, so it may be shorter than the real rotation vector by its stated error
/// (here `reachError`). The bound must still cover the second-order term of the real rotation.
TEST(MotionBounds, OneRotationWithARoundedRate) {
  for (const double amount : {0.02, 0.1, 0.4})
    for (const double error : {1e-2 * amount, 1e-3 * amount}) {
      const ScrewMotion screw{ScrewMotion::Kind::revolute, Vec3::UnitZ(), Vec3::Zero(), amount, 0};
      RelativeMotion w;
      w.screws = {&screw, 1};
      w.angular = (amount - error) * Vec3::UnitZ();
      w.angle = w.angular.norm();
      w.reachError = error;
      const MotionBound bound = motionBound(w, Vec3::UnitX(), 0);
      // Towards the axis, the point moves by 1 − cos of the angle, whose first-order term is 0.
      const Vec3 n = Vec3::UnitX();
      EXPECT_GE(bound.secondOrderAcross * n.cross(w.angular).norm() + bound.secondOrder,
                1 - std::cos(amount))
          << amount << ", rate off by " << error;
    }
}

/// A translation that follows a rotation is rotated, too. This gives a second-order term, although
/// at a point on the axis neither joint alone has one.
TEST(MotionBounds, SlideAfterATurn) {
  using Kind = ScrewMotion::Kind;
  const ScrewMotion screws[] = {{Kind::revolute, Vec3::UnitZ(), Vec3::Zero(), 0.1, 0},
                                {Kind::prismatic, Vec3::UnitX(), Vec3::Zero(), 0.2, 0}};
  const RelativeMotion w = relativeMotionOf(screws, Vec3(0.2, 0, 0), Vec3(0, 0, 0.1));
  // The point is on the axis, and the translation moves it off the axis.
  const MotionBound bound = motionBound(w, Vec3::Zero(), 0);
  EXPECT_EQ(bound.secondOrderAcross, 0);
  EXPECT_NEAR(bound.secondOrder, 0.5 * (0.2 * 0.1 * 0.1 + 2 * 0.1 * 0.2), 1e-15);
  EXPECT_NEAR(bound.isotropic, 0.2, 1e-14);
}

/// `pad` does not contain the part of a tube that grows with the interval.
TEST(MotionBounds, Tubes) {
  using Kind = ScrewMotion::Kind;
  const ScrewMotion screws[] = {{Kind::spherical, Vec3::Zero(), Vec3(0, 0, 3), 0, 0.01},
                                {Kind::revolute, Vec3::UnitZ(), Vec3(4, 0, 0), 0, 0.02},
                                {Kind::prismatic, Vec3::UnitX(), Vec3::Zero(), 0.5, 0.1}};
  const MotionBound bound =
      motionBound(relativeMotionOf(screws, Vec3(0.5, 0, 0), Vec3::Zero()), Vec3(0, 0, 0), 0);
  EXPECT_NEAR(bound.pad, 0.01 * 3 + 0.02 * 4 + 0.1, 1e-14);
  EXPECT_NEAR(bound.isotropic, 0.5 + 0.5 * (0.01 + 0.02), 1e-14);
  EXPECT_NEAR(bound.secondOrder, 0.5 * (0.01 + 0.02), 1e-14);
}

/// Deviations from uniform motion add to the second-order term, with lever arms as long as the
/// following joints may reach. Such deviations must not add to `pad`.
TEST(MotionBounds, Deviations) {
  using Kind = ScrewMotion::Kind;
  const ScrewMotion screws[] = {{Kind::revolute, Vec3::UnitZ(), Vec3(4, 0, 0), 0, 0, 0.02},
                                {Kind::prismatic, Vec3::UnitX(), Vec3::Zero(), 0.5, 0, 0.1}};
  const MotionBound bound =
      motionBound(relativeMotionOf(screws, Vec3(0.5, 0, 0), Vec3::Zero()), Vec3(0, 0, 0), 0);
  const double deviated = 0.1 + 0.02 * (4 + 0.6);
  EXPECT_LT(bound.pad, 1e-12);
  EXPECT_NEAR(bound.secondOrder, deviated, 1e-13);
  EXPECT_NEAR(bound.isotropic, std::min(0.6 + 4 * chord(0.02), 0.5 + deviated), 1e-13);
}

}  // namespace
}  // namespace corridor
