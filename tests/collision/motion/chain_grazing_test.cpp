#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "collision/queries/interference.h"
#include "tests/collision/motion/bodies.h"
#include "tests/support/chain_motion.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::add;
using test::ChainMotion;
using Vec3L = ChainMotion::Vec3L;

/// Two joints move body b: two revolute joints, or a revolute and a prismatic joint. At t = 1 the
/// height of b above a plane is `gap`, at a point where body a touches the plane from below. If
/// `known` is true, no sampled time before t = 1 has b lower, so the verdict is known without an
/// oracle.
struct ChainGrazing {
  TriangleMesh a, b;
  std::vector<ChainMotion::Joint> joints;
  bool known = true;

  ChainGrazing(std::mt19937_64& random, int n, double gap) {
    const auto real = [&](double low = -1, double high = 1) {
      return std::uniform_real_distribution(low, high)(random);
    };
    const auto vector = [&] { return Vec3(real(), real(), real()); };
    for (int j = 0; j < 2; ++j) {
      ChainMotion::Joint joint;
      joint.slides = n % 4 == 1 + j;
      joint.axis = vector(), joint.point = 2 * vector();
      joint.to = real(-3, 3);
      joint.from = joint.to + real() * (n % 3 ? 1.5 : 5);
      if (n % 7 < 3) joint.bend = real(-2, 2);
      joints.push_back(joint);
    }
    if (n % 5 == 0) joints[1].axis = joints[0].axis;
    const ChainMotion motion(joints);
    const Vec3 up = vector().normalized(), u = up.unitOrthogonal(), v = up.cross(u),
               x = 2 * vector();
    const double spread = real(0, 6.28);
    const auto around = [&](int i, double r) {
      return Vec3(r * (std::cos(2.1 * i + spread) * u + std::sin(2.1 * i + spread) * v));
    };
    Triangle low, high;
    for (int i = 0; i < 3; ++i) low[i] = around(i, real(0.3, 1));
    high = {Vec3::Zero(), around(0, 0.5) + up, around(1, 0.8) + up * real(0.3, 1)};
    if (n % 2) {  // a's corner under b's face
      std::swap(low, high);
      for (Vec3& p : low) p = Vec3(p - 2 * up * up.dot(p));
    }
    const auto end = motion.pose(1);
    const auto toBody = [&](const Vec3& p) {
      const Vec3L world = x.cast<long double>() + (p + gap * up).cast<long double>();
      return Vec3((end.R.transpose() * (world - end.t)).cast<double>());
    };
    add(a, x + low[0], x + low[1], x + low[2]);
    add(b, toBody(high[0]), toBody(high[1]), toBody(high[2]));
    for (int i = 0; i < 20; ++i) {  // more triangles, so that the trees have depth
      const Vec3 c = around(i, 1.5) + up * real(1, 2), d = around(i, 1.5) - up * real(0.5, 2);
      add(b, toBody(c), toBody(c + 0.1 * u), toBody(c + 0.1 * up));
      add(a, x + d, x + d + 0.1 * v, x + d - 0.1 * up);
    }
    const auto lowest = [&](long double t) {
      const auto X = motion.pose(t);
      long double least = 1e300L;
      for (const Vec3& p : b.vertices)
        least = std::min(
            least, (X * p.cast<long double>() - x.cast<long double>()).dot(up.cast<long double>()));
      return least;
    };
    const long double last = lowest(1);
    for (int i = 0; i < 200 && known; ++i) known = lowest(i / 200.0L) >= last - 1e-17L;
    for (int k = 3; k < 12 && known; ++k) known = lowest(1 - std::pow(10.0L, -k)) >= last - 1e-17L;
  }
};

TEST(CertifyMotion, ChainsThatGrazeByConstruction) {
  std::mt19937_64 random(test::testSeed(23));
  const int count = test::casesOf(700, 50'000);
  int apart = 0, together = 0, falseFree = 0, falseContact = 0, notFree = 0, notFound = 0;
  QueryContext context;
  for (int n = 0; apart + together < count; ++n) {
    const double amount = std::pow(10.0, -2 - n % 12);
    const double gap = n / 12 % 2 ? amount : -amount;
    const ChainGrazing g(random, n, gap);
    if (!g.known) continue;
    (gap > 0 ? apart : together)++;
    MotionOptions options;
    options.tolerance = 1e-7;
    options.earliest = n % 2;
    const Body a("", g.a), b("", g.b);
    ChainMotion motion(g.joints);
    const MotionPair pair{&a, &b};
    const MotionResult r = certifyMotion(motion, {&pair, 1}, options, context);
    if (gap < 0) {
      falseFree += r.verdict == MotionVerdict::free;
      notFound += r.verdict != MotionVerdict::contact && amount > 1e-6;
    } else {
      falseContact += r.verdict == MotionVerdict::contact;
      notFree += r.verdict != MotionVerdict::free && amount > 2e-7;
    }
  }
  EXPECT_EQ(falseFree, 0);
  EXPECT_EQ(falseContact, 0);
  EXPECT_EQ(notFree, 0);
  EXPECT_EQ(notFound, 0);
  EXPECT_GT(apart, count / 4);
  EXPECT_GT(together, count / 4);
  std::cout << context.counters.boxTests / (apart + together) << " box tests per edge\n";
}

/// Random chains: if the verdict is `free`, no sampled pose may have a contact.
TEST(CertifyMotion, RandomChainsAgainstSamples) {
  std::mt19937_64 random(test::testSeed(24));
  const auto real = [&](double low = -1, double high = 1) {
    return std::uniform_real_distribution(low, high)(random);
  };
  const auto vector = [&] { return Vec3(real(), real(), real()); };
  const int count = test::casesOf(900, 20'000);
  int verdicts[3] = {};
  for (int n = 0; n < count; ++n) {
    TriangleMesh a, b;
    for (int i = 0; i < 40; ++i) {
      const Vec3 c = 3 * vector();
      add(a, c, c + 0.4 * vector(), c + 0.4 * vector());
      const Vec3 d = 0.4 * vector() + Vec3(1, 0, 0);
      add(b, d, d + 0.3 * vector(), d + 0.3 * vector());
    }
    std::vector<ChainMotion::Joint> joints;
    for (int j = 0; j < 1 + n % 6; ++j) {
      const double from = real(-3, 3);
      const double length = n % 10 == 0 ? 9 : std::pow(10.0, real(-2, 0));
      joints.push_back({real() > 0.5, vector(), 2 * vector(), from, from + length * real()});
      if (n % 4 == 3) joints.back().bend = length * real(-2, 2);
    }
    ChainMotion motion(joints);
    const Body bodyA("", a), bodyB("", b);
    const MotionPair pair{&bodyA, &bodyB};
    MotionOptions options;
    options.tolerance = 1e-7;
    QueryContext context;
    const MotionResult r = certifyMotion(motion, {&pair, 1}, options, context);
    ++verdicts[static_cast<int>(r.verdict)];
    const auto touches = [&](double t) {
      const auto X = motion.pose(t);
      return interference(Posed(bodyA.binaryTree()),
                          Posed(bodyB.binaryTree(), {X.R.cast<double>(), X.t.cast<double>()}),
                          context);
    };
    if (r.verdict == MotionVerdict::contact) {
      ASSERT_TRUE(touches(r.time)) << n;
    }
    if (r.verdict != MotionVerdict::free) continue;
    for (int i = 0; i <= 200; ++i) ASSERT_FALSE(touches(i / 200.0)) << n << " at " << i;
  }
  std::cout << verdicts[0] << " free, " << verdicts[1] << " contact, " << verdicts[2]
            << " undecided\n";
  EXPECT_GT(verdicts[0], count / 10);
  EXPECT_GT(verdicts[1], count / 10);
  EXPECT_LE(verdicts[2], 1 + count / 100'000);
}

}  // namespace
}  // namespace corridor
