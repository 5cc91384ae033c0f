// Tests the oracle for motions (tests/support/sturm_contact.h) by known roots, by first contacts in
// closed form, by static samples with rational linear programming, and by the reversed and the
// relative description of the same motion.
#include <random>

#include <gtest/gtest.h>

#include "tests/collision/motion/rational_scenes.h"
#include "tests/support/polynomial.h"
#include "tests/support/rational_contact.h"
#include "tests/support/reference_distance.h"
#include "tests/support/reference_motion.h"
#include "tests/support/support.h"

namespace corridor::test {
namespace {

Polynomial linear(int root, int denominator) {  // 0 at root/denominator
  return Polynomial({-root, denominator});
}

/// The roots of products of linear factors (some of them squared) and one factor without real roots
/// are known.
TEST(Polynomials, RootsThatAreKnown) {
  std::mt19937_64 random(testSeed(42));
  const auto whole = [&](int low, int high) {
    return std::uniform_int_distribution(low, high)(random);
  };
  for (int n = 0; n < 1000; ++n) {
    std::vector<std::pair<int, int>> known;  // in (0, 1], as fractions
    Polynomial p({whole(1, 5), 0, whole(1, 5)});
    for (int k = whole(0, 5); k > 0; --k) {
      const int of = whole(1, 40), root = whole(-10, of + 10);
      const Polynomial factor = linear(root, of);
      p = p * factor;
      if (whole(0, 3) == 0) p = p * factor;
      if (root > 0 && root <= of) known.emplace_back(root, of);
    }
    const auto less = [](const auto& a, const auto& b) {
      return a.first * b.second < b.first * a.second;
    };
    std::sort(known.begin(), known.end(), less);
    known.erase(std::unique(known.begin(), known.end(),
                            [&](const auto& a, const auto& b) { return !less(a, b); }),
                known.end());
    std::vector<Root> roots = rootsInUnitInterval(p);
    ASSERT_EQ(roots.size(), known.size()) << n;
    for (std::size_t i = 0; i < roots.size(); ++i) {
      const int root = known[i].first, of = known[i].second;
      ASSERT_EQ(roots[i].signOf(p), 0);
      ASSERT_EQ(roots[i].signOf(linear(root, of) * linear(5, 3)), 0);
      ASSERT_EQ(roots[i].signOf(linear(1'000'000 * root + 1, 1'000'000 * of)), -1);
      ASSERT_EQ(roots[i].signOf(linear(1'000'000 * root - 1, 1'000'000 * of)), 1);
      roots[i].narrow(70);
      ASSERT_EQ(roots[i].k() < 70, false);
      ASSERT_LT(roots[i].n() * of, Integer(root) << roots[i].k()) << "the lower end is left out";
      ASSERT_GE((roots[i].n() + 1) * of, Integer(root) << roots[i].k());
    }
  }
}

TEST(Polynomials, SignsAtAnIrrationalRoot) {
  const Polynomial half({-1, 0, 2});  // √½ = 0.70710678118…
  std::vector<Root> roots = rootsInUnitInterval(half * half * linear(1, 3));
  ASSERT_EQ(roots.size(), 2u);
  EXPECT_EQ(roots[1].signOf(half * linear(7, 2)), 0);
  EXPECT_EQ(roots[1].signOf(linear(707'106'781, 1'000'000'000)), 1);
  EXPECT_EQ(roots[1].signOf(linear(707'106'782, 1'000'000'000)), -1);
  EXPECT_EQ(roots[1].signOf(Polynomial({1, 0, -2, 0, 0, -1})), -1);
  EXPECT_EQ(roots[1].signOf(Polynomial()), 0);
  EXPECT_TRUE(rootsInUnitInterval(Polynomial({7})).empty());
}

RationalScene sceneNumber(int n, std::mt19937_64& random) {
  return RationalScene(random, static_cast<RationalScene::Kind>(n % RationalScene::kinds),
                       n % 5 != 0);
}

/// The oracle's motion must be the motion of the edge, which the test computes from its definition,
/// in long double.
TEST(SturmContact, MotionIsThatOfTheEdge) {
  std::mt19937_64 random(testSeed(43));
  for (int n = 0; n < 300; ++n) {
    const RationalScene scene = sceneNumber(n, random);
    const ReferenceMotion edge(scene.motion.from(), scene.motion.to());
    for (int i = 0; i <= 8; ++i) {
      const RationalMotion::Scaled pose = scene.motion.at(i / 8.0);
      const long double weight = pose.weight, t = scene.motion.time(i / 8.0L);
      for (const Vec3& p : scene.moving) {
        const auto at =
            ((pose.X.m.cast<long double>() * p.cast<long double>() + pose.X.t.cast<long double>()) /
             weight)
                .eval();
        // About ten roundings of 2^-64 each: of quaternions, of angles up to π, and of their
        // products.
        ASSERT_LE((at - edge.point(t, p)).norm(), 0x1p-57L * (p.norm() + at.norm())) << n;
      }
    }
  }
}

TEST(SturmContact, ClosedForms) {
  for (const ClosedForm& form : closedForms()) {
    const FirstContact found = sturmContact(form.fixed, form.moving, form.motion);
    ASSERT_EQ(found.contact, form.first >= 0) << form.name;
    if (!found.contact) continue;
    EXPECT_LE(found.high - found.low, 0x1p-60L);
    EXPECT_NEAR(static_cast<double>(found.low - form.first), 0, 0x1p-58) << form.name;
    EXPECT_NEAR(static_cast<double>(found.high - form.first), 0, 0x1p-58) << form.name;
  }
}

/// No sample before the first contact may touch; if there is no contact, no sample may touch at
/// all. At the first contact the distance must be zero up to rounding.
TEST(SturmContact, Samples) {
  std::mt19937_64 random(testSeed(44));
  const int count = (isStressRun() ? 8'000 : 400) / kSlowdown;
  int contacts = 0, missed = 0, sampled = 0;
  for (int n = 0; n < count; ++n) {
    const RationalScene scene = sceneNumber(n, random);
    const FirstContact first = sturmContact(scene.fixed, scene.moving, scene.motion);
    contacts += first.contact;
    bool any = false;
    const auto sample = [&](double s) {
      const bool touches = touchesAt(scene.fixed, scene.moving, scene.motion, s);
      ASSERT_FALSE(touches && (!first.contact || s < first.low)) << n << " at " << s;
      any |= touches;
    };
    for (int i = 0; i <= 32; ++i) sample(i / 32.0);
    if (!first.contact) continue;
    for (int k = 6; k <= 12; ++k) {  // just before, and just after
      const auto steps = static_cast<double>(std::floor(std::ldexp(first.low, k)));
      sample(std::ldexp(steps, -k));
      sample(std::min(std::ldexp(steps + 1, -k), 1.0));
    }
    missed += !any;
    sampled += any;
    const RigidPose &from = scene.motion.from(), &to = scene.motion.to();
    const Transform X =
        RigidMotion::spatial(from, to, {}).at(static_cast<double>(scene.motion.time(first.low)));
    double size = from.p.norm() + to.p.norm();
    for (const Vec3& p : scene.moving) size = std::max(size, p.norm());
    if (!rationalContact(scene.fixed, {}, scene.moving, X)) {
      // The limit covers the error of the pose (rigid_motion.cpp), and the error of the time, which
      // is multiplied by angles of up to π.
      ASSERT_LE(referenceDistance(scene.fixed, {}, scene.moving, X), 0x1p-42 * size) << n;
    }
  }
  std::cout << contacts << " of " << count << " in contact; samples saw " << sampled
            << " of them, and missed " << missed << "\n";
  EXPECT_GT(contacts, count / 3);
  EXPECT_GT(count - contacts, count / 5);
  if (count >= 400) {  // with sanitizers there are fewer cases, and perhaps none with a missed
                       // contact
    EXPECT_GT(missed, count / 200) << "samples must miss some contacts";
  }
}

/// The reversed motion must touch, too. The motion relative to the other triangle must touch at the
/// same time.
TEST(SturmContact, InvariantUnderOtherDescriptions) {
  std::mt19937_64 random(testSeed(45));
  const int count = (isStressRun() ? 10'000 : 500) / kSlowdown;
  int swapped = 0;
  for (int n = 0; n < count; ++n) {
    const RationalScene scene = sceneNumber(n, random);
    const RationalMotion& motion = scene.motion;
    const RigidPose &from = motion.from(), &to = motion.to();
    const bool turns = !motion.m().isZero(0);
    const FirstContact first = sturmContact(scene.fixed, scene.moving, motion);
    ASSERT_EQ(sturmContact(
                  scene.fixed, scene.moving,
                  turns ? RationalMotion::turn(to, -motion.m()) : RationalMotion::line(to, from.p))
                  .contact,
              first.contact)
        << n;
    if (from.q.coeffs() != Eigen::Quaterniond::Identity().coeffs()) continue;
    Triangle fixed = scene.fixed;  // as seen from the first reference point of the moving triangle
    bool exact = true;
    for (Vec3& p : fixed)
      for (int k = 0; k < 3; ++k) {
        const long double difference = static_cast<long double>(p[k]) - from.p[k];
        p[k] -= from.p[k];
        exact = exact && p[k] == difference;
      }
    if (!exact) continue;  // a coordinate that was moved by 2^-40 may have no spare bit
    ++swapped;
    const FirstContact other = sturmContact(
        scene.moving, fixed,
        turns ? RationalMotion::turn({}, -motion.m()) : RationalMotion::line({}, from.p - to.p));
    ASSERT_EQ(other.contact, first.contact) << n;
    ASSERT_EQ(other.low, first.low) << n;
  }
  EXPECT_GT(swapped, count / 4);
}

TEST(SturmContact, WhatDoublesCannotHoldIsRefused) {
  const RigidPose odd{Vec3::Zero(), Eigen::Quaterniond(1, 0x1p-40, 0, 0)};
  EXPECT_THROW(RationalMotion::turn(odd, Vec3(0x1p-40, 0, 0)), std::invalid_argument);
  EXPECT_THROW(RationalMotion::turn({}, Vec3::Zero()), std::invalid_argument);
  const RationalMotion motion = RationalMotion::turn({}, Vec3(1, 1, 0));
  EXPECT_THROW(motion.at(0x1p-40), std::invalid_argument);
  EXPECT_EQ(motion.at(0.5).weight, 1.5);
}

}  // namespace
}  // namespace corridor::test
