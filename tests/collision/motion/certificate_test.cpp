#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "collision/motion/check_certificate.h"
#include "collision/queries/distance.h"
#include "tests/collision/motion/bodies.h"
#include "tests/collision/queries/every_target.h"
#include "tests/support/floating_point.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::add;
using test::at;
using test::blob;
using test::bodyOf;
using test::box;
using test::randomEdge;
using test::turned;
using FaultKind = CertificateFault::Kind;

/// A motion of one body past a fixed body, and what is tested about it: the answer of the query,
/// which returns a certificate, and the result of checking this certificate.
struct Case {
  const Body &fixed, &moving;
  RigidMotion motion;
  MotionOptions options;
  MotionResult result;
  MotionCertificate certificate;
  QueryContext context;

  Case(const Body& fixed_, const Body& moving_, const RigidMotion& motion_, double tolerance = 1e-7)
      : fixed(fixed_), moving(moving_), motion(motion_) {
    options.tolerance = tolerance;
    options.earliest = true;
  }
  MotionPair pair() const { return {&fixed, &moving}; }
  void run() {
    RigidEdge edge(motion);
    const MotionPair one = pair();
    result = certifyMotion(edge, {&one, 1}, options, context, &certificate);
  }
  std::optional<CertificateFault> check() {
    RigidEdge edge(motion);
    const MotionPair one = pair();
    return checkCertificate(edge, {&one, 1}, options, result.certifiedUntil, certificate, context);
  }
  double leastClearance() const {
    double least = HUGE_VAL;
    for (const FreeInterval& i : certificate.free) least = std::min(least, i.clearance);
    return least;
  }
};

class Certificate : public test::EveryTarget {};
INSTANTIATE_TEST_SUITE_P(Simd, Certificate, testing::ValuesIn(test::simdTargets()),
                         test::targetName);

TEST_P(Certificate, ASlideHasTheClearanceOfItsGap) {
  const Body wall = bodyOf(box(Vec3(-10, 1, -10), Vec3(10, 1.5, 10))),
             cube = bodyOf(box(Vec3(-0.5, -0.5, -0.5), Vec3(0.5, 0.5, 0.5)));
  for (const double gap : {0.25, 1e-2, 1e-3}) {
    Case slide(wall, cube,
               RigidMotion::spatial(at(Vec3(-5, 0.5 - gap, 0)), at(Vec3(5, 0.5 - gap, 0)), {}));
    slide.run();
    ASSERT_EQ(slide.result.verdict, MotionVerdict::free);
    EXPECT_FALSE(slide.certificate.point_A);
    EXPECT_LE(slide.leastClearance(), gap * (1 + 1e-12));
    // The cross product of two edges may be shorter than 1. As a separating axis, it may then prove
    // only a fraction of the gap.
    EXPECT_GE(slide.leastClearance(), 0.1 * gap);
    EXPECT_FALSE(slide.check());
  }
}

TEST_P(Certificate, IncludesMarginSlackAndTube) {
  const Body wall = bodyOf(box(Vec3(-10, 1, -10), Vec3(10, 1.5, 10))),
             cube = bodyOf(box(Vec3(-0.5, -0.5, -0.5), Vec3(0.5, 0.5, 0.5)));
  Case slide(wall, cube,
             RigidMotion::spatial(at(Vec3(-5, 0.4, 0)), at(Vec3(5, 0.4, 0)),
                                  {.position = 0.01, .rotation = 0}));
  slide.options.margin = 0.05;
  slide.options.clearanceSlack = 0.02;
  slide.run();
  ASSERT_EQ(slide.result.verdict, MotionVerdict::free);
  EXPECT_GE(slide.leastClearance(), 0.07 * (1 - 1e-12)) << "margin and clearance slack";
  // The tube may add 0.01 along each coordinate. The proof bounds this by a displacement of √3·0.01
  // in any direction.
  EXPECT_LE(slide.leastClearance(), 0.09 * (1 + 1e-12)) << "the tube reduces the clearance";
  EXPECT_FALSE(slide.check());
}

TEST_P(Certificate, TamperedWithItFails) {
  // At the end of its rotation the bar's corner is 0.03 from the wall.
  const Body wall = bodyOf(box(Vec3(-10, 1, -10), Vec3(10, 1.5, 10))),
             bar = bodyOf(box(Vec3(-1, -0.1, -0.1), Vec3(1, 0.1, 0.1)));
  Case swing(wall, bar,
             RigidMotion::spatial(at(Vec3(-2, 0.15, 0)),
                                  turned(Vec3(2, 0.15, 0), 0.85, Vec3::UnitZ()), {}));
  swing.run();
  ASSERT_EQ(swing.result.verdict, MotionVerdict::free);
  ASSERT_GT(swing.certificate.free.size(), 2U);
  ASSERT_FALSE(swing.check());
  const MotionCertificate whole = swing.certificate;
  const auto fault = [&] {
    const auto found = swing.check();
    swing.certificate = whole;
    EXPECT_TRUE(found);
    return found ? found->kind : FaultKind::malformed;
  };

  for (std::size_t i = 0; i < whole.free.size(); ++i) {
    swing.certificate.free.erase(swing.certificate.free.begin() + static_cast<std::ptrdiff_t>(i));
    EXPECT_EQ(fault(), FaultKind::gap) << i;
  }
  auto least = std::min_element(
      swing.certificate.free.begin(), swing.certificate.free.end(),
      [](const FreeInterval& x, const FreeInterval& y) { return x.clearance < y.clearance; });
  least->clearance = 1;  // a false claim: the bar comes closer than half of this clearance
  EXPECT_EQ(fault(), FaultKind::refuted);
  swing.certificate.free[0].pair = 1;
  EXPECT_EQ(fault(), FaultKind::malformed);
  swing.certificate.free[0].clearance = std::nan("");
  EXPECT_EQ(fault(), FaultKind::malformed);
  swing.certificate.free[0].clearance = 0;
  EXPECT_EQ(fault(), FaultKind::malformed) << "a clearance of 0";
  swing.certificate.free[0].t1 = 0.1;
  EXPECT_EQ(fault(), FaultKind::malformed) << "t1 is not on the grid";
  swing.certificate.free[0].t1 = 1.5;
  EXPECT_EQ(fault(), FaultKind::malformed);
  swing.certificate.free[0].t1 = swing.certificate.free[0].t0;
  EXPECT_EQ(fault(), FaultKind::malformed);
  swing.options.margin = 1;
  EXPECT_EQ(fault(), FaultKind::malformed) << "less than the required clearance";
}

/// If the distance does not exceed the margin, no claim may be accepted, even if the distance is
/// only a little smaller.
TEST_P(Certificate, AMarginIsProvedInFull) {
  const Body wall = bodyOf(box(Vec3(-10, 1, -10), Vec3(10, 1.5, 10))),
             cube = bodyOf(box(Vec3(-0.5, -0.5, -0.5), Vec3(0.5, 0.5, 0.5)));
  for (const double gap : {0.08, 0.095, 0.0999999, 0.1, 0.11, 0.2}) {
    Case slide(wall, cube,
               RigidMotion::spatial(at(Vec3(-5, 0.5 - gap, 0)), at(Vec3(5, 0.5 - gap, 0)), {}),
               1e-9);
    slide.options.margin = 0.1;
    slide.options.workLimit = 500'000;
    slide.result.certifiedUntil = 1;
    slide.certificate.free = {{0, 0, 1, 0.1}};
    EXPECT_EQ(slide.check().has_value(), gap <= 0.1) << gap;
    // The proof must also cover the full tube: two millimetres along y.
    slide.motion = RigidMotion::spatial(at(Vec3(-5, 0.5 - gap, 0)), at(Vec3(5, 0.5 - gap, 0)),
                                        {.position = 0.002, .rotation = 0});
    EXPECT_EQ(slide.check().has_value(), gap <= 0.102) << gap << " with a tube";
  }
}

TEST_P(Certificate, OtherArithmeticIsRefused) {
  const Body wall = bodyOf(box(Vec3(-10, 1, -10), Vec3(10, 1.5, 10))),
             cube = bodyOf(box(Vec3(-0.5, -0.5, -0.5), Vec3(0.5, 0.5, 0.5)));
  Case slide(wall, cube, RigidMotion::spatial(at(Vec3(-5, 0, 0)), at(Vec3(5, 0, 0)), {}));
  slide.run();
  for (const auto& setting : test::floatingPointSettings()) {
    std::optional<CertificateFault> fault;
    {
      const test::WithFloatingPoint set(setting);
      fault = slide.check();
    }
    ASSERT_EQ(fault.has_value(), !setting.standard()) << setting.name;
    if (fault) {
      EXPECT_EQ(fault->kind, FaultKind::floatingPoint);
    }
  }
}

TEST_P(Certificate, AHalfTurnIsNoEdge) {
  const Body wall = bodyOf(box(Vec3(-10, 5, -10), Vec3(10, 6, 10))),
             cube = bodyOf(box(Vec3(-0.5, -0.5, -0.5), Vec3(0.5, 0.5, 0.5)));
  Case turn(
      wall, cube,
      RigidMotion::spatial(at(Vec3::Zero()), {Vec3::Zero(), Eigen::Quaterniond(0, 0, 0, 1)}, {}));
  turn.result.certifiedUntil = 1;
  turn.certificate.free = {{0, 0, 1, 0.1}};
  ASSERT_TRUE(turn.check());
  EXPECT_EQ(turn.check()->kind, FaultKind::ambiguous);
}

TEST_P(Certificate, WhatIsInsideASolidIsNotFree) {
  const TriangleMesh shell = box(Vec3(-3, -3, -3), Vec3(3, 3, 3)),
                     small = box(Vec3(-0.5, -0.5, -0.5), Vec3(0.5, 0.5, 0.5));
  const Body surface = bodyOf(shell), solid("solid", shell, true), cube = bodyOf(small),
             ball("ball", ConvexPart{{Vec3::Zero()}, 0.5, false});
  for (const Body* moving : {&cube, &ball})
    for (const Body* fixed : {&surface, &solid}) {
      Case inside(*fixed, *moving, RigidMotion::spatial(at(Vec3(-1, 0, 0)), at(Vec3(1, 0, 0)), {}));
      inside.result.certifiedUntil = 1;
      inside.certificate.free = {{0, 0, 1, 0.5}};
      const auto fault = inside.check();
      EXPECT_EQ(fault.has_value(), fixed == &solid);
      if (fault) {
        EXPECT_EQ(fault->kind, FaultKind::refuted);
      }
      // Now the solid shell moves, and the body inside is at rest.
      Case around(*moving, *fixed, RigidMotion::spatial(at(Vec3(-1, 0, 0)), at(Vec3(1, 0, 0)), {}));
      around.result.certifiedUntil = 1;
      around.certificate.free = {{0, 0, 1, 0.5}};
      EXPECT_EQ(around.check().has_value(), fixed == &solid);
    }
}

TEST_P(Certificate, TheWorkLimitEndsTheCheck) {
  std::mt19937_64 random(test::testSeed(42));
  const Body wall = bodyOf(box(Vec3(-10, 1, -10), Vec3(10, 1.5, 10))),
             cloud = bodyOf(blob(random, 200, 0.5, 0.3));
  Case slide(wall, cloud, RigidMotion::spatial(at(Vec3(-5, -1, 0)), at(Vec3(5, -1, 0)), {}));
  slide.run();
  ASSERT_EQ(slide.result.verdict, MotionVerdict::free);
  ASSERT_FALSE(slide.check());
  slide.options.workLimit = 3;
  ASSERT_TRUE(slide.check());
  EXPECT_EQ(slide.check()->kind, FaultKind::workLimit);
}

/// These certificates make large claims, some of them false. If a certificate is accepted, its
/// claim must hold at samples, margin and tube included.
TEST_P(Certificate, AcceptedClaimsHold) {
  std::mt19937_64 random(test::testSeed(43));
  int accepted = 0, refused = 0;
  for (int n = 0; n < 400; ++n) {
    const Body fixed = bodyOf(blob(random, 20, 2, 0.3)), moving = bodyOf(blob(random, 6, 0.3, 0.3));
    const auto [a, b] = randomEdge(random);
    const Tube tube{n % 2 ? 0.01 : 0, n % 4 / 2 ? 0.01 : 0};
    Case c(fixed, moving, RigidMotion::spatial(a, b, tube), 1e-6);
    c.options.margin = n % 3 ? 0.1 * std::uniform_real_distribution(0.0, 1.0)(random) : 0;
    // Computes distances at samples of the nominal motion, and of motions on the boundary of the
    // tube.
    double least = HUGE_VAL, leastInTube = HUGE_VAL;
    for (int k = 0; k <= 64; ++k) {
      Transform X = c.motion.at(k / 64.0);
      const auto apart = [&] {
        return distance(Posed(fixed.binaryTree()), Posed(moving.binaryTree(), X), {}, c.context)
            .distance;
      };
      least = std::min(least, apart());
      const Vec3 away = Vec3::NullaryExpr([&] { return random() % 2 ? 1.0 : -1.0; });
      X.m = Eigen::AngleAxisd(tube.rotation, away.normalized()) * X.m;
      X.t += tube.position * away;
      leastInTube = std::min(leastInTube, apart());
    }
    const double claim = c.options.margin + std::pow(10.0, -(n % 6)) * least;
    c.result.certifiedUntil = 1;
    c.certificate.free = {{0, 0, 1, claim + 1e-12}};
    if (c.check()) {
      ++refused;
      continue;
    }
    ++accepted;
    ASSERT_GT(leastInTube, c.options.margin) << n;
    // Whatever the direction, the tube can move the body by `tube.position` towards the other body.
    ASSERT_GT(least, c.options.margin + tube.position) << n;
  }
  EXPECT_GT(accepted, 20);
  EXPECT_GT(refused, 20);
}

/// The check uses the tube's effect on the farthest point for the whole body. So it may fail to
/// prove a true claim, but it must not report that the claim is false.
TEST_P(Certificate, TubesRefuteNoTrueClaim) {
  TriangleMesh two;
  add(two, Vec3::Zero(), Vec3(0.01, 0, 0), Vec3(0, 0, 0.01));
  add(two, Vec3(10, 5, 0), Vec3(10.01, 5, 0), Vec3(10, 5, 0.01));
  TriangleMesh floor;
  add(floor, Vec3(-0.1, -0.006, -0.1), Vec3(0.1, -0.006, -0.1), Vec3(0, -0.006, 0.1));
  const Body fixed = bodyOf(floor), moving = bodyOf(two);
  Case c(fixed, moving, RigidMotion::spatial(at(Vec3::Zero()), at(Vec3(0, 0.001, 0)), {0, 0.01}));
  c.run();
  ASSERT_EQ(c.result.verdict, MotionVerdict::free);
  const auto fault = c.check();
  if (fault) {
    EXPECT_EQ(fault->kind, FaultKind::unproved);
  }
}

/// Two bodies pass through each other. No claim may be accepted, not even a claim of a tiny
/// clearance, and not even if products of lengths overflow. The check must also end in these cases.
TEST_P(Certificate, FalseClaimsAreNotBelieved) {
  for (const double size : {1.0, 1e160}) {
    const Body fixed = bodyOf(box(-size * Vec3::Ones(), size * Vec3::Ones())),
               moving = bodyOf(box(-size * Vec3::Ones(), size * Vec3::Ones()));
    for (const double claim : {1.0, 1e-3, 1e-17, 1e-300}) {
      Case c(fixed, moving,
             RigidMotion::spatial(at(Vec3(-3 * size, 0, 0)),
                                  turned(Vec3(3 * size, 0, 0), 1e-3, Vec3::UnitZ()), {0, 1e-3}));
      c.result.certifiedUntil = 1;
      c.certificate.free = {{0, 0, 1, claim}};
      EXPECT_TRUE(c.check()) << size << ' ' << claim;
      c.result.certifiedUntil = std::nan("");
      EXPECT_TRUE(c.check());
    }
  }
}

/// All certificates of random motions must be accepted by the check, and must agree with distances
/// at samples, which are computed independently.
TEST_P(Certificate, RandomMotions) {
  std::mt19937_64 random(test::testSeed(41));
  int free = 0, contact = 0;
  for (int n = 0; n < 200; ++n) {
    // In two of three rounds, one of the bodies is a convex part instead of a mesh.
    const auto make = [&](int which, int count, double spread) {
      return n % 3 == which ? Body("", ConvexPart{{Vec3::Zero(), spread * Vec3(0.3, 0.2, 0.1)},
                                                  0.2 * spread,
                                                  false})
                            : bodyOf(blob(random, count, spread, 0.3));
    };
    const Body fixed = make(0, 60, 2), moving = make(1, 12, 0.3);
    const auto [a, b] = randomEdge(random);
    Case c(fixed, moving, RigidMotion::spatial(a, b, {}));
    c.options.earliest = n % 2;
    c.run();
    const MotionResult result = c.result;
    RigidEdge edge(c.motion);
    const MotionPair pair = c.pair();
    const MotionResult bare = certifyMotion(edge, {&pair, 1}, c.options, c.context);
    ASSERT_EQ(bare.verdict, result.verdict) << n;
    EXPECT_EQ(bare.certifiedUntil, result.certifiedUntil);
    EXPECT_EQ(bare.time, result.time);
    const auto fault = c.check();
    EXPECT_FALSE(fault) << n << ": kind " << int(fault->kind) << " at " << fault->t;
    for (const FreeInterval& i : c.certificate.free)
      for (int k = 0; k <= 4; ++k) {
        const Transform X = c.motion.at(i.t0 + (i.t1 - i.t0) * k / 4);
        const double d =
            distance(Posed(fixed.binaryTree()), Posed(moving.binaryTree(), X), {}, c.context)
                .distance;
        ASSERT_GE(d, i.clearance * (1 - 1e-12) - 1e-14) << n;
      }
    free += result.verdict == MotionVerdict::free;
    if (result.verdict != MotionVerdict::contact) {
      EXPECT_FALSE(c.certificate.point_A);
      continue;
    }
    ++contact;
    ASSERT_TRUE(c.certificate.point_A) << n;
    TriangleMesh dot;
    const Vec3 p = *c.certificate.point_A;
    add(dot, p, p, p);
    const Body point = bodyOf(dot);
    const Transform X = c.motion.at(result.time);
    for (const auto& [body, pose] : {std::pair(&fixed, Transform()), std::pair(&moving, X)})
      EXPECT_LT(distance(Posed(body->binaryTree(), pose), Posed(point.binaryTree()), {}, c.context)
                    .distance,
                1e-13)
          << n;
  }
  EXPECT_GT(free, 30);
  EXPECT_GT(contact, 30);
}

}  // namespace
}  // namespace corridor
