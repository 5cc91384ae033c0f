#include "collision/motion/motion_window.h"

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

/// All that a bound depends on, at the middle of a window, and one point, place and direction to
/// try it at.
struct Trial {
  struct Joint {
    ScrewTravel::Kind kind;
    Vec3 axis, point;
    double amount;  // signed
    double tube;    // ≥ 0
    double strays;  // in [−1, 1], of the tube
    Vec3 about;     // balls: what it strays about
  };
  std::vector<Joint> joints;
  Vec3 center, origin, offset, direction;  // offset: in the unit ball
  double radius, s;
};

struct Ratios {
  double cap = 0, beyond = 0, pad = 0, all = 0;
};

/// What the point really does, in long double, over what `travelOf` allows.
Ratios ratios(const Trial& trial) {
  MotionWindow w;
  std::vector<ScrewTravel> screws;
  w.X_AB.t = trial.origin;
  for (const Trial::Joint& joint : trial.joints) {
    const Vec3 axis = joint.axis.normalized();
    screws.push_back({joint.kind, axis, joint.point, std::abs(joint.amount), joint.tube});
    if (joint.kind == ScrewTravel::Kind::slide) w.linear += joint.amount * axis;
    if (joint.kind != ScrewTravel::Kind::turn) continue;
    w.linear += joint.amount * axis.cross(trial.origin - joint.point);
    w.angular += joint.amount * axis;
  }
  w.screws = screws;
  w.speed = roundedUp(w.linear.norm());
  w.angle = roundedUp(w.angular.norm());
  w.fixedError = w.reachError = 0x1p-48;  // the doubles above against the long doubles below

  const Vec3 x = trial.center + trial.radius * trial.offset;
  const auto place = [&](long double s, long double share) {
    Vec3L p = x.cast<long double>();
    for (std::size_t j = trial.joints.size(); j-- > 0;) {
      const Trial::Joint& joint = trial.joints[j];
      const Vec3L axis = joint.axis.cast<long double>().normalized(),
                  point = joint.point.cast<long double>();
      const long double stray = share * joint.strays * joint.tube;
      if (joint.kind == ScrewTravel::Kind::slide) {
        p += axis * (s * joint.amount + stray);
      } else if (joint.kind == ScrewTravel::Kind::turn) {
        p = point + ChainMotion::turn(axis, s * joint.amount + stray) * (p - point);
      } else {
        p = point +
            ChainMotion::turn(joint.about.cast<long double>().normalized(), stray) * (p - point);
      }
    }
    return p;
  };
  const PointTravel bound = travelOf(w, trial.center, trial.radius);
  const Vec3L start = x.cast<long double>(), nominal = place(trial.s, 0), real = place(trial.s, 1);
  const Vec3L n = trial.direction.cast<long double>().normalized();
  const Vec3L first = (w.linear + w.angular.cross(x - trial.origin)).cast<long double>();
  const double bend =
      bound.bend * static_cast<double>(n.cross(w.angular.cast<long double>()).norm()) +
      bound.curvature;
  // Of lengths that rounding doesn't rule.
  const auto ratio = [](long double is, double allowed) {
    return allowed > 1e-9 ? static_cast<double>(is) / allowed : 0;
  };
  // The chain told in long double is this far from the window's doubles; `pad` has it.
  const double told = w.fixedError + w.reachError * (x - trial.origin).norm();
  Ratios r;
  r.cap = ratio((nominal - start).norm() - told, bound.cap);
  r.beyond = ratio(std::abs(n.dot(nominal - start - trial.s * first)) - told, bend);
  r.pad = ratio((place(0, 1) - start).norm(), bound.pad);
  r.all = std::max(
      ratio((real - start).norm(), bound.cap + bound.pad),
      ratio(std::abs(n.dot(real - start)),
            std::min(bound.cap, static_cast<double>(std::abs(n.dot(first))) + bend) + bound.pad));
  return r;
}

/// Chains of all sorts: parallel, equal and intersecting axes, slides before and after turns, turns
/// over π, balls, joints that stand still.
Trial start(Random& random, int n) {
  Trial trial;
  const int count = 1 + n % 5;
  const double size = std::pow(10.0, -real(random, 0, 4));  // of the amounts
  for (int j = 0; j < count; ++j) {
    Trial::Joint joint;
    const double kind = real(random, 0, 1);
    joint.kind = kind < 0.6   ? ScrewTravel::Kind::turn
                 : kind < 0.9 ? ScrewTravel::Kind::slide
                              : ScrewTravel::Kind::ball;
    joint.axis = vector(random), joint.point = 2 * vector(random), joint.about = vector(random);
    if (j > 0 && n % 3 == 0) joint.axis = trial.joints[0].axis;
    if (j > 0 && n % 4 == 0) joint.point = trial.joints[0].point;
    joint.amount = real(random) * (n % 7 ? size : 7);
    if (joint.kind == ScrewTravel::Kind::ball || real(random) > 0.7) joint.amount = 0;
    joint.tube = n % 2 ? 0 : real(random, 0, 0.1) * size;
    joint.strays = real(random);
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
    if (some()) joint.about += step * vector(random);
  }
  if (some()) trial.center += step * vector(random);
  if (some()) trial.origin += step * vector(random);
  if (some()) trial.direction = trial.direction.normalized() + step * vector(random);
  if (some()) trial.offset = (trial.offset + step * vector(random)).normalized();
  if (some()) trial.s = std::clamp(trial.s + step * real(random), -1.0, 1.0);
  return trial;
}

/// Adversarial: climb towards the greatest share of each bound that any chain attains. Never above
/// 1, and nearly 1 somewhere.
TEST(TravelOf, IsNeverExceededAndAttained) {
  Random random(test::testSeed(21));
  const int starts = test::stressAsked() ? 5000 : 300;
  double Ratios::*const goals[] = {&Ratios::cap, &Ratios::beyond, &Ratios::pad, &Ratios::all};
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
  std::cout << evaluations << " chains; attained: cap " << best[0] << ", beyond first order "
            << best[1] << ", tube " << best[2] << ", all " << best[3] << "\n";
  for (const double share : best) EXPECT_GT(share, 0.995);
}

/// The same, many joints at random; and how tight the bounds are, in the median.
TEST(TravelOf, RandomChains) {
  Random random(test::testSeed(22));
  const int count = test::stressAsked() ? 10'000'000 : 50'000;
  std::vector<double> shares;  // of the first ones
  for (int n = 0; n < count; ++n) {
    Trial trial = start(random, n);
    while (static_cast<int>(trial.joints.size()) < n % 12)
      for (const Trial::Joint& joint : start(random, n).joints) trial.joints.push_back(joint);
    if (n % 2) trial.s = n % 4 == 1 ? 1 : -1;
    const Ratios r = ratios(trial);
    for (const double share : {r.cap, r.beyond, r.pad, r.all}) ASSERT_LE(share, 1) << n;
    if (n < 50'000) shares.push_back(r.all);
  }
  const auto middle = shares.begin() + static_cast<std::ptrdiff_t>(shares.size() / 2);
  std::nth_element(shares.begin(), middle, shares.end());
  std::cout << "of the bound, in the median: " << *middle << "\n";
}

MotionWindow windowOf(std::span<const ScrewTravel> screws, const Vec3& linear,
                      const Vec3& angular) {
  MotionWindow w;
  w.screws = screws;
  w.linear = linear, w.angular = angular;
  w.speed = linear.norm(), w.angle = angular.norm();
  return w;
}

/// Closed forms.
TEST(TravelOf, OneTurn) {
  using Kind = ScrewTravel::Kind;
  const double pi = std::numbers::pi;
  for (const double amount : {1e-3, 0.5, 1.0, 2.0, 2.9, 3.0, pi, 4.0, 7.0, 100.0}) {
    const ScrewTravel turn{Kind::turn, Vec3::UnitZ(), Vec3(1, 2, 3), amount, 0};
    const Vec3 axis = amount * Vec3::UnitZ();
    const MotionWindow w = windowOf({&turn, 1}, axis.cross(-turn.point), axis);
    const PointTravel travel = travelOf(w, Vec3(1, 5, 8), 0.25);
    const double chord = 3.25 * 2 * std::sin(std::min(amount, pi) / 2);
    EXPECT_GE(travel.cap, chord);
    EXPECT_LE(travel.cap, 1.006 * chord);
    EXPECT_NEAR(travel.bend, 0.5 * 3.25 * amount, 1e-12 * amount);
    EXPECT_LE(travel.curvature, 1e-14 * amount * amount);
    EXPECT_LE(travel.pad, 1e-13);
  }
}

/// A slide after a turn turns with it: second order, though neither alone has any along the axis.
/// The stored rotation vector may be shorter than the real one by the error of the rate: the second
/// order of the real turn is within the bound all the same.
TEST(TravelOf, OneTurnWhoseRateIsOff) {
  for (const double amount : {0.02, 0.1, 0.4})
    for (const double error : {1e-2 * amount, 1e-3 * amount}) {
      const ScrewTravel screw{ScrewTravel::Kind::turn, Vec3::UnitZ(), Vec3::Zero(), amount, 0};
      MotionWindow w;
      w.screws = {&screw, 1};
      w.angular = (amount - error) * Vec3::UnitZ();
      w.angle = w.angular.norm();
      w.reachError = error;
      const PointTravel travel = travelOf(w, Vec3::UnitX(), 0);
      // Towards the axis the point goes by 1 − cos, of which the first order has nothing.
      const Vec3 n = Vec3::UnitX();
      EXPECT_GE(travel.bend * n.cross(w.angular).norm() + travel.curvature, 1 - std::cos(amount))
          << amount << ", rate off by " << error;
    }
}

TEST(TravelOf, SlideAfterATurn) {
  using Kind = ScrewTravel::Kind;
  const ScrewTravel screws[] = {{Kind::turn, Vec3::UnitZ(), Vec3::Zero(), 0.1, 0},
                                {Kind::slide, Vec3::UnitX(), Vec3::Zero(), 0.2, 0}};
  const MotionWindow w = windowOf(screws, Vec3(0.2, 0, 0), Vec3(0, 0, 0.1));
  const PointTravel travel = travelOf(w, Vec3::Zero(), 0);  // on the axis, but carried off it
  EXPECT_EQ(travel.bend, 0);
  EXPECT_NEAR(travel.curvature, 0.5 * (0.2 * 0.1 * 0.1 + 2 * 0.1 * 0.2), 1e-15);
  EXPECT_NEAR(travel.cap, 0.2, 1e-14);
}

/// Tubes: what grows with the window is not in `pad`.
TEST(TravelOf, Tubes) {
  using Kind = ScrewTravel::Kind;
  const ScrewTravel screws[] = {{Kind::ball, Vec3::Zero(), Vec3(0, 0, 3), 0, 0.01},
                                {Kind::turn, Vec3::UnitZ(), Vec3(4, 0, 0), 0, 0.02},
                                {Kind::slide, Vec3::UnitX(), Vec3::Zero(), 0.5, 0.1}};
  const PointTravel travel =
      travelOf(windowOf(screws, Vec3(0.5, 0, 0), Vec3::Zero()), Vec3(0, 0, 0), 0);
  EXPECT_NEAR(travel.pad, 0.01 * 3 + 0.02 * 4 + 0.1, 1e-14);
  EXPECT_NEAR(travel.cap, 0.5 + 0.5 * (0.01 + 0.02), 1e-14);
  EXPECT_NEAR(travel.curvature, 0.5 * (0.01 + 0.02), 1e-14);
}

}  // namespace
}  // namespace corridor
