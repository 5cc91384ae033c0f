// One suite for all methods that prove motions, on trees of every kind. It tests closed forms,
// motions that graze by construction, and random motions, for which the methods are compared with
// static samples and with each other.
#include <array>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "collision/motion/edge_method.h"
#include "collision/queries/interference.h"
#include "tests/collision/motion/bodies.h"
#include "tests/collision/motion/grazing.h"
#include "tests/support/floating_point.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::add;
using test::at;
using test::blob;
using test::bodyOf;
using test::box;
using test::Grazing;
using test::Proof;
using test::randomEdge;
using test::turned;

class EdgeMethods : public testing::TestWithParam<Proof> {
 protected:
  EdgeMethods() { options_.tolerance = 1e-7; }
  MotionResult ask(const Body& moving, const Body& fixed, const RigidMotion& motion) {
    return test::certify(moving, fixed, motion, options_, context_, GetParam());
  }
  /// Returns whether the bodies touch at a static pose.
  bool touch(const Body& moving, const Body& fixed, const Transform& X) {
    return interference(Posed(fixed.binaryTree()), Posed(moving.binaryTree(), X), context_)
        .has_value();
  }

  MotionOptions options_;
  QueryContext context_;
};

INSTANTIATE_TEST_SUITE_P(All, EdgeMethods, test::everyProof(), test::proofName);

TEST_P(EdgeMethods, SlideBesideAWall) {
  const Body wall = bodyOf(box(Vec3(-10, 1, -10), Vec3(10, 1.5, 10))),
             cube = bodyOf(box(Vec3(-0.5, -0.5, -0.5), Vec3(0.5, 0.5, 0.5)));
  for (const double gap : {0.25, 0.02, 1e-3, -1e-6, -1e-3, -0.25}) {
    context_.counters = {};
    const RigidMotion slide =
        RigidMotion::spatial(at(Vec3(-5, 0.5 - gap, 0)), at(Vec3(5, 0.5 - gap, 0)), {});
    EXPECT_EQ(ask(cube, wall, slide).verdict,
              gap > 0 ? MotionVerdict::free : MotionVerdict::contact)
        << gap;
    EXPECT_EQ(context_.counters.edges, 1u);
    EXPECT_EQ(context_.counters.states, 0u) << "queries within an edge must not count as states";
    if (gap > 0) {
      // If an interval is proved, the body may move by up to twice the gap in it. Halving makes
      // intervals shorter than necessary, by a factor of two at most. `advancement` computes up to
      // three motion bounds per step.
      EXPECT_LE(static_cast<double>(context_.counters.poses), 64 + 4 * 10 / gap) << gap;
    }
  }
}

/// If a displacement overflows, the verdict must be neither `contact` nor `free`.
TEST_P(EdgeMethods, DisplacementsThatOverflowAreUndecided) {
  const Body cube = bodyOf(box(Vec3(-0.5, -0.5, -0.5), Vec3(0.5, 0.5, 0.5))),
             aside = bodyOf(box(Vec3(-1, 5, -1), Vec3(1, 6, 1)));
  for (const double far : {1e308, 9e307}) {
    const MotionResult result =
        ask(cube, aside, RigidMotion::spatial(at(Vec3(far, 0, 0)), at(Vec3(-far, 0, 0)), {}));
    EXPECT_EQ(result.verdict, MotionVerdict::undecided) << far;
  }
}

/// In a mode that does not round to nearest, or that shortens the x87's numbers, no bound holds.
/// The query must report the floating-point mode as the reason, and must not answer `free` or
/// `contact`.
TEST_P(EdgeMethods, OtherArithmeticIsRefused) {
  const Body wall = bodyOf(box(Vec3(-10, 1, -10), Vec3(10, 1.5, 10))),
             cube = bodyOf(box(Vec3(-0.5, -0.5, -0.5), Vec3(0.5, 0.5, 0.5)));
  for (const double gap : {0.25, -0.25}) {
    const RigidMotion slide =
        RigidMotion::spatial(at(Vec3(-5, 0.5 - gap, 0)), at(Vec3(5, 0.5 - gap, 0)), {});
    for (const auto& setting : test::floatingPointSettings()) {
      MotionResult result;
      {
        const test::WithFloatingPoint set(setting);
        result = ask(cube, wall, slide);
      }
      if (!setting.standard()) {
        EXPECT_EQ(result.verdict, MotionVerdict::undecided) << setting.name;
        EXPECT_EQ(result.reason, UndecidedReason::floatingPoint) << setting.name;
        EXPECT_EQ(result.certifiedUntil, 0);
      } else {
        EXPECT_EQ(result.verdict, gap > 0 ? MotionVerdict::free : MotionVerdict::contact)
            << setting.name;
      }
    }
  }
}

TEST_P(EdgeMethods, FirstContactOfATranslation) {
  const Body wall = bodyOf(box(Vec3(-10, 1, -10), Vec3(10, 1.5, 10))),
             cube = bodyOf(box(Vec3(-0.5, -0.5, -0.5), Vec3(0.5, 0.5, 0.5)));
  options_.earliest = true;
  for (const double clearanceSlack : {0.0, 1e-3, 1e-2}) {
    if (clearanceSlack > 0 && GetParam().method == EdgeMethod::certified)
      continue;  // `certified` stops only at ends of bisected intervals
    options_.clearanceSlack = clearanceSlack;
    const MotionResult r =
        ask(cube, wall, RigidMotion::spatial(at(Vec3(0, -5, 0)), at(Vec3(0, 5, 0)), {}));
    const double first = 0.55;  // 5.5 of 10 m
    EXPECT_LE(r.certifiedUntil, first - clearanceSlack / 10);
    EXPECT_GE(r.certifiedUntil, first - clearanceSlack / 10 - options_.timeTolerance);
    if (clearanceSlack < 5e-3) {
      ASSERT_EQ(r.verdict, MotionVerdict::contact) << clearanceSlack;
      EXPECT_GE(r.time, first - 1e-15);
      EXPECT_LE(r.time - r.certifiedUntil, options_.timeTolerance);
      EXPECT_TRUE(r.pair);
    }
  }
}

/// A blade of length 1 rotates about z; a point is at the distance 1 + gap from the axis. A point
/// has no interior. When the blade's edge sweeps over the point, no sampled time shows a contact,
/// only a clearance below the tolerance. If the gap is negative, the verdict must not be `free`.
TEST_P(EdgeMethods, BladeAgainstAPoint) {
  TriangleMesh blade;
  add(blade, Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.2, 0, 0.1));
  const Body bladeBody = bodyOf(blade);
  options_.earliest = true;
  for (const double gap : {1e-2, 1e-4, 1e-6, 3e-7, -1e-9, -1e-6, -1e-2}) {
    TriangleMesh point;
    const Vec3 p = (1 + gap) * Vec3(std::cos(0.7), std::sin(0.7), 0);
    add(point, p, p, p);
    const Body pointBody = bodyOf(point);
    const MotionResult r =
        ask(bladeBody, pointBody,
            RigidMotion::spatial({}, turned(Vec3::Zero(), 2.5, Vec3::UnitZ()), {}));
    if (gap > 0) {
      EXPECT_EQ(r.verdict, MotionVerdict::free) << gap;
      EXPECT_EQ(r.certifiedUntil, 1);
    } else {
      EXPECT_NE(r.verdict, MotionVerdict::free) << gap;
      EXPECT_LE(r.certifiedUntil, 0.7 / 2.5) << gap;
      EXPECT_GT(r.certifiedUntil, 0.7 / 2.5 - 1e-3) << gap;
    }
  }
}

TEST_P(EdgeMethods, ThinPlateIsNotJumped) {
  const Body plate = bodyOf(box(Vec3(-5, -5, 0), Vec3(5, 5, 1e-4))),
             cube = bodyOf(box(Vec3(-0.1, -0.1, -1e-3), Vec3(0.1, 0.1, 1e-3)));
  options_.tolerance = 1e-8;
  for (const bool earliest : {false, true}) {
    options_.earliest = earliest;
    const MotionResult r =
        ask(cube, plate, RigidMotion::spatial(at(Vec3(0, 0, -7)), at(Vec3(0, 0, 6)), {}));
    ASSERT_EQ(r.verdict, MotionVerdict::contact);
    const double first = (7 - 1e-3) / 13;
    EXPECT_GE(r.time, first - 1e-15);
    EXPECT_LE(r.certifiedUntil, first);
    if (earliest) {
      EXPECT_LE(r.time - r.certifiedUntil, options_.timeTolerance);
    }
  }
}

TEST_P(EdgeMethods, MarginTubeSlackAndWorkLimit) {
  const Body wall = bodyOf(box(Vec3(-10, 1, -10), Vec3(10, 1.5, 10))),
             cube = bodyOf(box(Vec3(-0.5, -0.5, -0.5), Vec3(0.5, 0.5, 0.5)));
  // The clearance is 0.1. For methods other than `certified` the motion is shorter, because they
  // take small steps if the margin is nearly as large as the clearance.
  const double way = GetParam().method == EdgeMethod::certified ? 5 : 0.01;
  const RigidPose a = at(Vec3(-way, 0.4, 0)), b = at(Vec3(way, 0.4, 0));
  Tube tube;
  const auto verdict = [&](const RigidPose& from, const RigidPose& to) {
    return ask(cube, wall, RigidMotion::spatial(from, to, tube));
  };
  options_.margin = 0.0999;
  EXPECT_EQ(verdict(a, b).verdict, MotionVerdict::free);
  EXPECT_EQ(verdict(a, a).verdict, MotionVerdict::free);
  options_.margin = 0.1001;
  EXPECT_EQ(verdict(a, b).verdict, MotionVerdict::contact);
  EXPECT_EQ(verdict(a, a).verdict, MotionVerdict::contact) << "a state is an edge of zero length";
  options_.margin = 0;
  tube = {0.05, 0.01};  // √3·0.05 + 0.01·√0.75 = 0.095
  EXPECT_EQ(verdict(a, b).verdict, MotionVerdict::free);
  tube = {0.06, 0.01};
  const MotionResult r = verdict(a, b);
  EXPECT_EQ(r.verdict, MotionVerdict::undecided);
  EXPECT_EQ(r.reason, UndecidedReason::clearance);
  EXPECT_NEAR(r.gap, 0.1, 1e-9);
  EXPECT_EQ(verdict(a, a).reason, UndecidedReason::clearance) << "only the tube moves the body";
  tube = {};
  options_.clearanceSlack = 0.0999;
  EXPECT_EQ(verdict(a, b).verdict, MotionVerdict::free);
  options_.clearanceSlack = 0.1001;
  EXPECT_EQ(verdict(a, b).reason, UndecidedReason::clearance)
      << "too close to be free, but no contact";
  EXPECT_EQ(verdict(a, a).reason, UndecidedReason::clearance);
  options_.clearanceSlack = 0;
  EXPECT_EQ(context_.counters.undecided, 4u);
  options_.hulls = false;
  for (const std::uint64_t limit : {3, 100'000}) {
    options_.workLimit = limit;
    context_.counters = {};
    // `certified` needs less work than the larger limit.
    if (limit > 3 && GetParam().method == EdgeMethod::certified) continue;
    const MotionResult beside = verdict(at(Vec3(-5, 0.5 - 1e-6, 0)), at(Vec3(5, 0.5 - 1e-6, 0)));
    EXPECT_EQ(beside.reason, UndecidedReason::workLimit) << limit;
    EXPECT_LT(context_.counters.poses, limit / 10 + 10) << "the query ends soon after the limit";
  }
}

TEST_P(EdgeMethods, AmbiguousHalfTurn) {
  const Body far = bodyOf(box(Vec3(100, 0, 0), Vec3(101, 1, 1))),
             cube = bodyOf(box(Vec3(-1, -1, -1), Vec3(1, 1, 1)));
  const MotionResult r =
      ask(cube, far,
          RigidMotion::spatial({}, turned(Vec3::Zero(), std::numbers::pi, Vec3(1, 2, 3)), {}));
  EXPECT_EQ(r.verdict, MotionVerdict::undecided);
  EXPECT_EQ(r.reason, UndecidedReason::ambiguous);
  EXPECT_EQ(context_.counters.edges, 1u);
  EXPECT_EQ(context_.counters.undecided, 1u);
}

TEST_P(EdgeMethods, FarBodiesGetNoTree) {
  const Body far = bodyOf(box(Vec3(100, 0, 0), Vec3(101, 1, 1))),
             cube = bodyOf(box(Vec3(-1, -1, -1), Vec3(1, 1, 1)));
  EXPECT_EQ(ask(cube, far, RigidMotion::spatial({}, at(Vec3(5, 0, 0)), {})).verdict,
            MotionVerdict::free);
  EXPECT_FALSE(far.treeBuilt());
}

/// All triangles of a body have the same centroid, so no split divides them: both bodies have a
/// leaf with many triangles.
TEST_P(EdgeMethods, LeavesOfManyTriangles) {
  TriangleMesh nested, needle;
  for (const double s : {1.0, 2.0, 4.0, 8.0})
    add(nested, s * Vec3(-1, -1, 0), s * Vec3(2, -1, 0), s * Vec3(-1, 2, 0));
  // Triangles that point down, each longer than the one before.
  for (const double s : {0.01, 0.02, 0.5})
    add(needle, s * Vec3(0, 0, -2), s * Vec3(0.1, 0, 1), s * Vec3(-0.1, 0, 1));
  const Body plate = bodyOf(nested), tip = bodyOf(needle);
  // The needle comes down on an edge of the plate's third triangle, inside the third triangle,
  // inside the fourth triangle only, or beside all triangles.
  for (const double x : {0.0, 3.0, 10.0, 13.0}) {
    const bool hits = x < 12;
    const auto through = [&](double sign) {  // the tips are 1 below the origin: at −1.5 in the end
      return RigidMotion::spatial(at(sign * Vec3(x, -4 + x / 64, 2)),
                                  at(sign * Vec3(x, -4 + x / 64, -0.5)), {});
    };
    const MotionVerdict expected = hits ? MotionVerdict::contact : MotionVerdict::free;
    for (const bool earliest : {false, true}) {
      options_.earliest = earliest;
      EXPECT_EQ(ask(tip, plate, through(1)).verdict, expected) << x;
      EXPECT_EQ(ask(plate, tip, through(-1)).verdict, expected) << x;
    }
  }
}

/// A triangle that is a single point is beside the middle of an edge. So the closest feature is
/// neither a corner nor the face.
TEST_P(EdgeMethods, PointBesideAnEdge) {
  TriangleMesh large, point;
  add(large, Vec3(-1, 0, 0), Vec3(1, 0, 0), Vec3(0, 2, 0));
  add(point, Vec3::Zero(), Vec3::Zero(), Vec3::Zero());
  const Body plate = bodyOf(large), dot = bodyOf(point);
  for (const double margin : {0.0, 0.0999, 0.1001})
    for (const RigidPose& to :
         {at(Vec3(0.1, -0.1, 0)), turned(Vec3(0.1, -0.1, 0), 1, Vec3(1, 2, 3))}) {
      options_.margin = margin;
      const RigidPose from = at(Vec3(-0.1, -0.1, 0));
      const MotionVerdict expected = margin > 0.1 ? MotionVerdict::contact : MotionVerdict::free;
      EXPECT_EQ(ask(dot, plate, RigidMotion::spatial(from, to, {})).verdict, expected) << margin;
      const RigidPose back = at(Vec3(0.1, 0.1, 0)), fro = at(Vec3(-0.1, 0.1, 0));
      EXPECT_EQ(ask(plate, dot, RigidMotion::spatial(back, fro, {})).verdict, expected) << margin;
    }
}

/// The size of points is 0, so no motion bound is small compared with their size. Halving must end
/// at intervals of 2^-48 of the motion, without a stack overflow.
TEST_P(EdgeMethods, PointThroughAPointEnds) {
  TriangleMesh mesh;
  add(mesh, Vec3::Zero(), Vec3::Zero(), Vec3::Zero());
  const Body point = bodyOf(mesh);
  std::mt19937_64 random(test::testSeed(6));
  std::uniform_real_distribution<double> u(1, 2);
  options_.tolerance = 1e-300;
  for (int i = 0; i < 100; ++i) {
    options_.earliest = i % 2;
    context_.counters = {};
    const MotionResult r =
        ask(point, point,
            RigidMotion::spatial(at(Vec3(-u(random), 0, 0)), at(Vec3(u(random), 0, 0)), {}));
    EXPECT_NE(r.verdict, MotionVerdict::free);
    EXPECT_LT(context_.counters.poses, 1000u);
  }
}

/// At t = 1/4 the tip of a fixed body is within the tube, and at t = 0.49 the moving body hits a
/// wall. Between these times nothing grazes.
TEST_P(EdgeMethods, GrazingIsReportedOnlyForNarrowGaps) {
  TriangleMesh robot, tip, wall;
  add(robot, Vec3(-0.01, 0, 0), Vec3(0.01, 0, 0), Vec3(0, 0.01, 0));
  add(tip, Vec3(0.25, 0, -1e-9), Vec3(0.25, -1, -1), Vec3(0.25, 1, -1));
  add(wall, Vec3(0.5, -1, -1), Vec3(0.5, 1, -1), Vec3(0.5, 0, 1));
  const Body moving = bodyOf(robot), fixed[] = {bodyOf(tip), bodyOf(wall)};
  const MotionPair pairs[] = {{&fixed[0], &moving, 0, 0, 2}, {&fixed[1], &moving, 0, 1, 2}};
  options_.tolerance = 1e-12;
  options_.earliest = true;
  RigidEdge edge(RigidMotion::spatial(at(Vec3::Zero()), at(Vec3::UnitX()), {1e-8, 0}));
  const MotionResult r = GetParam()(edge, pairs, options_, context_);
  EXPECT_EQ(r.verdict, MotionVerdict::undecided);
  EXPECT_FALSE(r.grazing);
  EXPECT_LE(r.certifiedUntil, 0.25);
  // All other methods stop where an interval cannot be proved.
  if (GetParam().method != EdgeMethod::certified) {
    EXPECT_GT(r.certifiedUntil, 0.2);
    EXPECT_EQ(r.pair->bodyA, 0u);
  }
}

/// The motion is so short that the clearance is below twice the tolerance on the whole way to the
/// contact.
TEST_P(EdgeMethods, SlowContactGrazes) {
  const Body wall = bodyOf(box(Vec3(-10, 1, -10), Vec3(10, 1.5, 10))),
             cube = bodyOf(box(Vec3(-0.5, -0.5, -0.5), Vec3(0.5, 0.5, 0.5)));
  options_.earliest = true;
  const MotionResult r =
      ask(cube, wall,
          RigidMotion::spatial(at(Vec3(0, 0.5 - 5e-8, 0)), at(Vec3(0, 0.5 + 1.5e-7, 0)), {}));
  ASSERT_EQ(r.verdict, MotionVerdict::contact);
  EXPECT_GE(r.time, 0.25 - 1e-6);
  EXPECT_LE(r.certifiedUntil, 0.25 + 1e-6);
  EXPECT_TRUE(r.grazing || r.time - r.certifiedUntil <= options_.timeTolerance);
}

/// `free` and `contact` must never be false. The verdict must be `free` if the clearance is above
/// twice the tolerance and the work limit is not reached.
TEST_P(EdgeMethods, GrazingByConstruction) {
  std::mt19937_64 random(test::testSeed(8));
  const int count = test::casesOf(420, 10'000);
  int apart = 0, together = 0, free = 0, contact = 0, tooMuch = 0;
  for (int n = 0; apart + together < count; ++n) {
    const double size = std::pow(10.0, n % 5 - 2);
    const double amount = std::pow(10.0, -2 - n % 12);
    const double gap = n / 12 % 2 ? amount : -amount;
    const auto feature = static_cast<Grazing::Feature>(n % 7 % Grazing::features);
    const Grazing g(random, feature, n % 3 == 0, gap, size);
    if (!g.known) continue;
    (gap > 0 ? apart : together)++;
    options_.tolerance = 1e-7 * size;
    options_.earliest = n % 2;
    options_.workLimit = 500'000;
    const MotionResult r =
        ask(bodyOf(g.moving), bodyOf(g.fixed), RigidMotion::spatial(g.from, g.to, {}));
    const bool limit = r.reason == UndecidedReason::workLimit;
    tooMuch += limit;
    if (!options_.earliest && r.verdict != MotionVerdict::free) {
      ASSERT_EQ(r.certifiedUntil, 0) << "the time was not requested";
      ASSERT_FALSE(r.grazing) << "grazing is reported only with `earliest`";
    }
    if (gap < 0) {
      ASSERT_NE(r.verdict, MotionVerdict::free) << n;
      contact += r.verdict == MotionVerdict::contact;
      if (amount > 1e-6 && !limit) {
        EXPECT_EQ(r.verdict, MotionVerdict::contact) << n;
      }
    } else {
      ASSERT_NE(r.verdict, MotionVerdict::contact) << n;
      free += r.verdict == MotionVerdict::free;
      if (amount > 2e-7 && !limit) {
        EXPECT_EQ(r.verdict, MotionVerdict::free) << n;
      }
    }
    if (options_.earliest && r.verdict == MotionVerdict::contact) {
      ASSERT_TRUE(r.grazing || r.time - r.certifiedUntil <= options_.timeTolerance) << n;
    }
  }
  std::cout << free << " of " << apart << " free, " << contact << " of " << together
            << " in contact, " << tooMuch << " took too much work\n";
  EXPECT_GT(free, apart / 5);
  EXPECT_GT(contact, together / 4);
  if (GetParam().method == EdgeMethod::certified) {
    EXPECT_EQ(tooMuch, 0);
  }
}

/// If the verdict is `free`, no sampled pose may have a contact. If the verdict is `contact`, the
/// pose at the reported time must have a contact. No method, on any kind of trees, may contradict
/// the default method.
TEST_P(EdgeMethods, RandomEdges) {
  std::mt19937_64 random(test::testSeed(9));
  const int count = test::isStressRun() ? 5'000 : 400;
  std::array<int, 3> verdicts = {};
  for (int n = 0; n < count; ++n) {
    const Body fixed = bodyOf(blob(random, 60, 2, 0.3)),
               moving = bodyOf(blob(random, 12, 0.3, 0.3));
    const auto [a, b] = randomEdge(random);
    const RigidMotion motion = RigidMotion::spatial(a, b, {0x1p-40 * 4, 0x1p-40 * 6});
    options_.earliest = false;
    const MotionResult r = ask(moving, fixed, motion);
    ++verdicts.at(static_cast<std::size_t>(r.verdict));
    QueryContext other;
    const MotionResult known = test::certify(moving, fixed, motion, options_, other);
    if (r.verdict != MotionVerdict::undecided && known.verdict != MotionVerdict::undecided) {
      ASSERT_EQ(r.verdict, known.verdict) << n;
    }
    options_.earliest = true;
    const MotionResult first = ask(moving, fixed, motion);
    ASSERT_EQ(r.verdict == MotionVerdict::free, first.verdict == MotionVerdict::free) << n;
    const double until = r.verdict == MotionVerdict::free ? 1 : first.certifiedUntil;
    for (int i = 0; i <= 100 && until > 0; ++i)
      ASSERT_FALSE(touch(moving, fixed, motion.at(until * i / 100))) << n << " at " << i;
    if (r.verdict == MotionVerdict::contact) {
      ASSERT_TRUE(touch(moving, fixed, motion.at(r.time))) << n;
    }
    if (first.verdict == MotionVerdict::contact) {
      ASSERT_TRUE(touch(moving, fixed, motion.at(first.time))) << n;
      ASSERT_TRUE(first.grazing || first.time - first.certifiedUntil <= options_.timeTolerance);
    }
  }
  std::cout << verdicts[0] << " free, " << verdicts[1] << " contact, " << verdicts[2]
            << " undecided\n";
  EXPECT_GT(verdicts[0], count / 10);
  EXPECT_GT(verdicts[1], count / 10);
  EXPECT_LE(verdicts[2], 1 + count / 100'000);
}

/// Convex parts: a rod of radius 0.1 along z, and a sphere of radius 0.2 that swings away from the
/// rod, or moves into the rod.
TEST_P(EdgeMethods, BallAroundARod) {
  const Body ball("ball", placed(Sphere{0.2}, Transform{Mat3::Identity(), Vec3(1, 0, 0)})),
      rod("rod", placed(Cylinder{0.1, 4}, {}));
  // In the xy-plane, the sphere's centre is at (gap − 0.7 + cos φ, sin φ), φ in [0, 0.5]. The
  // sphere begins `gap` beside the rod, or in the rod if `gap` is negative, and moves away, since
  // 1.49 − 1.4 cos φ increases.
  const auto around = [&](double gap) {
    return RigidMotion::spatial(turned(Vec3(gap - 0.7, 0, 0), 0, Vec3::UnitZ()),
                                turned(Vec3(gap - 0.7, 0, 0.5), 0.5, Vec3::UnitZ()), {});
  };
  for (const double gap : {0.01, 1e-4, 1e-6}) {
    EXPECT_EQ(ask(ball, rod, around(gap)).verdict, MotionVerdict::free) << gap;
  }
  for (const double gap : {-1e-6, -0.01}) {
    EXPECT_EQ(ask(ball, rod, around(gap)).verdict, MotionVerdict::contact) << gap;
  }
  options_.earliest = true;
  const MotionResult r =
      ask(ball, rod, RigidMotion::spatial(at(Vec3(1, 0, 0)), at(Vec3(-3, 0, 0)), {}));
  ASSERT_EQ(r.verdict, MotionVerdict::contact);
  const double first = 1.7 / 4;  // the centre moves from 2 to 0.3
  EXPECT_LE(r.certifiedUntil, first);
  EXPECT_GE(r.time, first - 1e-12);
  EXPECT_LE(r.time - r.certifiedUntil, options_.timeTolerance);
}

}  // namespace
}  // namespace corridor
