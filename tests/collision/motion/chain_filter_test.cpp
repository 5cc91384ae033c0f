#include "collision/motion/chain_filter.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <optional>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "collision/convex/convex_distance.h"
#include "collision/convex/point_columns.h"
#include "tests/collision/queries/every_target.h"
#include "tests/support/support.h"

namespace corridor {
namespace chain_filter {
namespace {

using Random = std::mt19937_64;
constexpr std::uint32_t kNone = ChainScene::kNone;

double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

Vec3 randomVector(Random& random, double size) {
  return {uniform(random, -size, size), uniform(random, -size, size), uniform(random, -size, size)};
}

Mat3 randomRotation(Random& random) {
  std::normal_distribution<double> normal;
  return Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
      .normalized()
      .toRotationMatrix();
}

/// A scene with the sets that its hulls view, and an edge of its joints.
struct Case {
  ChainScene scene;
  std::vector<JointMotion> motions;
  std::vector<Mat3> turnAxes;  // axis× of each joint
  std::deque<PointColumns> columns;
  std::deque<ConvexPart> parts;
  std::deque<ConvexSet> sets;

  void addJoint(std::uint32_t parent, bool slides, const Transform& fixed, const Vec3& axis,
                double from, double to, double tube = 0) {
    Mat3 K;
    K << 0, -axis[2], axis[1], axis[2], 0, -axis[0], -axis[1], axis[0], 0;
    JointMotion m;
    m.shift = fixed.t;
    m.length = 1.0001 * fixed.t.norm();
    m.tube = tube;
    m.rotationError = m.shiftError = 1e-14;
    m.rate = to - from;
    m.largestRate = std::abs(m.rate) * (1 + 1e-14);
    if (slides) {
      scene.joints.push_back({parent, true, fixed.m, Mat3::Zero(), Mat3::Zero(), fixed.m * axis});
      m.shift += from * (fixed.m * axis);
      m.slide = (to - from) * (fixed.m * axis);
      m.length += 1.0001 * std::max(std::abs(from), std::abs(to));
    } else {
      scene.joints.push_back(
          {parent, false, fixed.m, fixed.m * K, fixed.m * K * K, fixed.m * axis});
      m.angle = from;
    }
    motions.push_back(m);
  }
  const ConvexSet* hullOf(ConvexPart part) {
    parts.push_back(std::move(part));
    sets.emplace_back(parts.back());
    return &sets.back();
  }
  const ConvexSet* hullOf(std::vector<Vec3> points) {
    columns.emplace_back(std::move(points));
    sets.emplace_back(columns.back());
    return &sets.back();
  }
  void addLink(std::uint32_t joint, const Transform& X_JB, const ConvexSet* hull) {
    Vec3 center = Vec3::Zero();
    for (const Vec3& p : hull->points) center += p / static_cast<double>(hull->points.size());
    double radius = 0;
    for (const Vec3& p : hull->points) radius = std::max(radius, (p - center).norm());
    scene.links.push_back(
        {joint, X_JB, center, radius * (1 + 1e-14) + hull->ball + hull->disc, hull});
  }
  void addObstacle(bool isCylinder, const Transform& X_W, const Vec3& half) {
    const Primitive shape =
        isCylinder ? Primitive(Cylinder{half[0], 2 * half[2]}) : Primitive(Box{2 * half});
    scene.obstacles.push_back({isCylinder, X_W, half, {}, hullOf(placed(shape, X_W))});
  }
  void addPair(bool isWorld, std::uint32_t a, std::uint32_t b) {
    scene.pairs.push_back({isWorld, a, b, static_cast<std::uint32_t>(scene.pairs.size())});
  }

  /// The pose of a joint at t, with each joint's value moved by `off` tubes.
  Transform poseOf(std::uint32_t joint, double t, const std::vector<double>& off) const {
    if (joint == kNone) return {};
    const ChainScene::Joint& j = scene.joints[joint];
    const JointMotion& m = motions[joint];
    const double more = off[joint] * m.tube;
    const double phi = m.angle + t * m.rate + more;
    const Transform X = {j.fixed + std::sin(phi) * j.sine + (1 - std::cos(phi)) * j.versine,
                         m.shift + t * m.slide + (j.slides ? Vec3(more * j.axis) : Vec3(0, 0, 0))};
    return poseOf(j.parent, t, off) * X;
  }
  double distanceOf(const ChainScene::Pair& pair, double t, const std::vector<double>& off) const {
    const ChainScene::Link& b = scene.links[pair.b];
    const Transform X_WB = poseOf(b.joint, t, off) * b.X_JB;
    if (pair.isWorld) {
      const ChainScene::Obstacle& a = scene.obstacles[pair.a];
      return convexDistance({*a.hull, a.X_WB}, {*b.hull, X_WB}, 1e-8, 1e-11).distance;
    }
    const ChainScene::Link& a = scene.links[pair.a];
    return convexDistance({*a.hull, poseOf(a.joint, t, off) * a.X_JB}, {*b.hull, X_WB}, 1e-8, 1e-11)
        .distance;
  }
};

/// The least distance that samples of the edge find, with joint values at the ends of their tubes.
double leastSampled(const Case& c, const ChainScene::Pair& pair, int samples, Random& random) {
  std::vector<double> off(c.motions.size());
  double least = std::numeric_limits<double>::infinity(), at = 0;
  const auto sample = [&](double t) {
    const double d = c.distanceOf(pair, t, off);
    if (d < least) least = d, at = t;
  };
  const bool isWidened =
      std::ranges::any_of(c.motions, [](const JointMotion& m) { return m.tube > 0; });
  for (int corner = 0; corner < (isWidened ? 4 : 1); ++corner) {
    for (double& o : off) o = isWidened ? (random() % 2 ? 1 : -1) : 0;
    sample(0);
    if (samples == 0) continue;
    for (int i = 1; i <= samples; ++i) sample(double(i) / samples);
    for (double step = 0.5 / samples; step > 1e-4; step /= 2)
      for (const double t : {at - step, at + step})
        if (t >= 0 && t <= 1) sample(t);
  }
  return least;
}

std::vector<std::uint32_t> leftOf(const ChainFilter& filter, const Case& c,
                                  const std::vector<double>& margins) {
  const PairMargins each(margins);
  MotionOptions options;
  options.tolerance = 1e-12;
  options.pairMargins = &each;
  ChainFilter::Scratch scratch;
  std::vector<std::uint32_t> left, again;
  filter.pairsLeft(c.motions, options, scratch, left);
  filter.pairsLeft(c.motions, options, scratch, again);
  EXPECT_EQ(left, again);
  return left;
}

/// Two chains of random joints and links among random obstacles.
Case randomCase(Random& random, double motion, double tube) {
  Case c;
  std::vector<std::uint32_t> ends = {kNone};
  for (int chain = 0; chain < 2; ++chain) {
    std::uint32_t parent = kNone;
    for (int j = 0; j < 4; ++j) {
      const bool slides = random() % 4 == 0;
      const double from = uniform(random, -3, 3) * (slides ? 0.1 : 1);
      c.addJoint(parent, slides, {randomRotation(random), randomVector(random, 0.4)},
                 randomVector(random, 1).normalized(), from,
                 from + motion * uniform(random, -1, 1) * (slides ? 0.3 : 1), tube);
      parent = static_cast<std::uint32_t>(c.scene.joints.size() - 1);
      ends.push_back(parent);
    }
  }
  for (const std::uint32_t joint : ends) {
    const Transform X_JB = {randomRotation(random), randomVector(random, 0.1)};
    if (random() % 3 == 0) {
      c.addLink(joint, X_JB,
                c.hullOf(placed(
                    random() % 2 ? Primitive(Cylinder{0.05, 0.3}) : Primitive(Capsule{0.05, 0.3}),
                    {randomRotation(random), randomVector(random, 0.1)})));
      continue;
    }
    std::vector<Vec3> points;
    for (int i = 0; i < 11; ++i) points.push_back(randomVector(random, 0.15));
    c.addLink(joint, X_JB, c.hullOf(points));
  }
  for (int i = 0; i < 6; ++i)
    c.addObstacle(random() % 3 == 0, {randomRotation(random), randomVector(random, 1)},
                  Vec3(0.1, 0.1, uniform(random, 0.05, 0.4)));
  for (std::uint32_t b = 0; b < c.scene.links.size(); ++b) {
    for (std::uint32_t o = 0; o < c.scene.obstacles.size(); ++o) c.addPair(true, o, b);
    for (std::uint32_t a = 0; a < b; ++a)
      if (random() % 2)
        c.addPair(false, a, b);
      else
        c.addPair(false, b, a);
  }
  return c;
}

class ChainFilterOn : public test::EveryTarget {};
INSTANTIATE_TEST_SUITE_P(Simd, ChainFilterOn, testing::ValuesIn(test::simdTargets()),
                         test::targetName);

/// A margin just above a distance that a sample has can't be kept; it must not be proved. A margin
/// a little below it mostly is.
TEST_P(ChainFilterOn, ProvesNoMarginThatASampleBreaks) {
  Random random(test::testSeed(71));
  int pairs = 0, proved = 0;
  for (int n = 0; n < test::casesOf(60, 20'000); ++n) {
    const double motion =
        std::array{0.0, 1e-4, 0.03, 0.3, 2.0, 6.0}[static_cast<std::size_t>(n % 6)];
    const Case c = randomCase(random, motion, n % 4 == 0 ? 1e-3 : 0);
    const ChainFilter filter(c.scene);
    std::vector<double> broken, kept;
    for (const ChainScene::Pair& pair : c.scene.pairs) {
      const double least = leastSampled(c, pair, motion > 0 ? 20 : 0, random);
      broken.push_back(least + 1e-9);
      kept.push_back(std::max(0.0, least - 0.002 - 0.05 * motion));
    }
    EXPECT_EQ(leftOf(filter, c, broken).size(), c.scene.pairs.size()) << "case " << n;
    const std::vector<std::uint32_t> left = leftOf(filter, c, kept);
    pairs += static_cast<int>(c.scene.pairs.size());
    proved += static_cast<int>(c.scene.pairs.size() - left.size());
  }
  RecordProperty("proved", proved);
  EXPECT_GT(proved, pairs / 2) << "of " << pairs;
}

/// A point that turns about an axis inside a slab's distance: the gap is concave in t, so only the
/// second order keeps the proof sound. The least distance, at the ends, is known in closed form.
TEST_P(ChainFilterOn, CoversTheSecondOrder) {
  Random random(test::testSeed(72));
  int proved = 0, count = 0;
  for (int n = 0; n < test::casesOf(1000, 500'000); ++n) {
    const double radius = uniform(random, 0.1, 1), half = uniform(random, 0.01, 0.4);
    const Transform X = {randomRotation(random), randomVector(random, 0.5)};
    Case c;
    c.addJoint(kNone, false, X, Vec3::UnitZ(), -half, half);
    ConvexPart point;
    point.points = {Vec3(radius, 0, 0)};
    c.addLink(0, {}, c.hullOf(point));
    const double face = 0.5 * radius * std::cos(half);
    Transform slab = X;
    slab.t = X * Vec3(face - 0.01, 0, 0);
    c.addObstacle(false, slab, Vec3(0.01, 5, 5));
    c.addPair(true, 0, 0);
    const ChainFilter filter(c.scene);
    const double least = radius * std::cos(half) - face;
    EXPECT_EQ(leftOf(filter, c, {least + 1e-9}).size(), 1u)
        << "case " << n << ": radius " << radius << ", half " << half;
    proved += leftOf(filter, c, {least - 1e-4 - 0.05 * radius * half * half / 16}).empty();
    ++count;
  }
  EXPECT_GT(proved, count * 9 / 10);
}

/// A body that is a point, in a ball of radius 0, whose hull is another point swept by a large
/// sphere: the second order is that of the hull's point. The least distance is known in closed
/// form.
TEST_P(ChainFilterOn, CoversHullsBeyondTheBall) {
  for (const double swept : {0.05, 0.35, 1.0})
    for (const double rate : {0.45, 0.9, 12.0}) {
      const double d = rate / (rate > 1 ? 128 : 16);
      // The first interval turns from -d to d.
      double far = 1 + swept;
      for (int k = 0; k < 200; ++k)
        far += 1 - Vec3(far - swept * std::cos(d), swept * std::sin(d), 0).norm();
      const Vec3 point(far - swept * std::cos(d), -swept * std::sin(d), 0);
      const double speed = (0.3 + swept) * rate;
      Case c;
      c.addJoint(kNone, true, {Mat3::Identity(), Vec3(0.2, 0, 0)}, Vec3::UnitX(), 0, speed);
      c.addJoint(0, false, {}, Vec3::UnitZ(), -d, rate - d);
      ConvexPart part;
      part.points = {Vec3(far, 0, 0)};
      part.radius = swept * (1 + 1e-12);
      c.addLink(1, {}, c.hullOf(part));
      c.scene.links[0].center = point;
      c.scene.links[0].radius = 0;
      c.addObstacle(false, {Mat3::Identity(), Vec3(-0.5, 0, 0)}, Vec3(0.5, 100, 100));
      c.addPair(true, 0, 0);
      double least = HUGE_VAL;
      for (int k = 0; k <= 200'000; ++k) {
        const double t = k / 2e5, phi = t * rate - d;
        least =
            std::min(least, 0.2 + speed * t + std::cos(phi) * point[0] - std::sin(phi) * point[1]);
      }
      EXPECT_EQ(leftOf(ChainFilter(c.scene), c, {least + 1e-9}).size(), 1u)
          << "swept " << swept << ", rate " << rate;
    }
}

/// Bodies at rest, millimetres apart and metres from the origin: only the errors of float keep the
/// proof sound.
TEST_P(ChainFilterOn, CoversTheRoundingOfFloats) {
  Random random(test::testSeed(73));
  int proved = 0, count = 0;
  for (int n = 0; n < test::casesOf(3000, 2'000'000); ++n) {
    Case c;
    std::uint32_t parent = kNone;
    for (int j = 0; j < 3; ++j) {
      const double value = uniform(random, -3, 3);
      c.addJoint(parent, false, {randomRotation(random), randomVector(random, 1)},
                 randomVector(random, 1).normalized(), value, value);
      parent = static_cast<std::uint32_t>(j);
    }
    ConvexPart part;
    part.points = {randomVector(random, 1)};
    if (n % 2) part.points.push_back(randomVector(random, 1));  // its ball is too large
    const Transform X_JB = {randomRotation(random), randomVector(random, 1)};
    c.addLink(parent, X_JB, c.hullOf(part));
    // The x axis of the obstacle leads to the first point.
    const Transform X_WB = c.poseOf(parent, 0, std::vector<double>(3)) * X_JB;
    const Vec3 p = X_WB * part.points[0];
    const Vec3 x = n % 2 ? Vec3((X_WB * part.points[1] - p).normalized())
                         : randomVector(random, 1).normalized();
    const Vec3 y = x.cross(randomVector(random, 1)).normalized();
    Transform X_WO;
    X_WO.m << x, y, x.cross(y);
    const double gap = uniform(random, 1e-3, 1e-2);
    X_WO.t = p - (0.3 + gap) * x + uniform(random, -0.05, 0.05) * (n % 3 == 0 ? 0.0 : 1.0) * y;
    c.addObstacle(n % 3 == 0, X_WO, Vec3(0.3, 0.3, 0.5));
    c.addPair(true, 0, 0);
    const ChainFilter filter(c.scene);
    const double d = c.distanceOf(c.scene.pairs[0], 0, std::vector<double>(3));
    EXPECT_EQ(leftOf(filter, c, {d + 1e-10}).size(), 1u) << "case " << n;
    proved += leftOf(filter, c, {d - 5e-4}).empty();
    ++count;
  }
  EXPECT_GT(proved, count * 9 / 10);
}

TEST(ChainFilter, TheSameOnEveryTarget) {
  Random random(test::testSeed(74));
  for (int n = 0; n < 20; ++n) {
    const Case c = randomCase(random, 0.5, 0);
    const ChainFilter filter(c.scene);
    const std::vector<double> margins(c.scene.pairs.size(), 0.01);
    std::optional<std::vector<std::uint32_t>> first;
    for (const std::int64_t target : test::simdTargets()) {
      hwy::SetSupportedTargetsForTest(target);
      const auto left = leftOf(filter, c, margins);
      if (!first) first = left;
      EXPECT_EQ(left, *first);
    }
    hwy::SetSupportedTargetsForTest(0);
  }
}

/// Touches whatever it is asked, and keeps the question.
struct Touches final : TouchTest {
  explicit Touches(bool answer) : answer_(answer) {}
  bool touches(std::uint32_t number, double t) override {
    numbers.push_back(number);
    times.push_back(t);
    return answer_;
  }
  std::vector<std::uint32_t> numbers;
  std::vector<double> times;

 private:
  bool answer_;
};

/// The pairs that a filter leaves of a case, by their numbers.
class Left {
 public:
  explicit Left(const Case& c) : case_(c), filter_(c.scene) { options_.tolerance = 1e-9; }
  const std::vector<std::uint32_t>& operator()(TouchTest* test,
                                               std::span<const std::uint8_t> proved = {}) {
    filter_.pairsLeft(case_.motions, options_, scratch_, left_, test, proved);
    return left_;
  }

 private:
  const Case& case_;
  ChainFilter filter_;
  MotionOptions options_;
  ChainFilter::Scratch scratch_;
  std::vector<std::uint32_t> left_;
};

TEST(ChainFilter, AsksAboutPairsWhoseHullsMeet) {
  Case c;
  c.addJoint(kNone, true, {}, Vec3::UnitX(), 0, 1);
  c.addLink(0, {}, c.hullOf(placed(Box{Vec3(0.2, 0.2, 0.2)}, {})));
  c.addObstacle(false, {Mat3::Identity(), Vec3(0.5, 0, 0)}, Vec3(0.1, 0.1, 0.1));
  c.addObstacle(false, {Mat3::Identity(), Vec3(0.5, 0, 9)}, Vec3(0.1, 0.1, 0.1));
  c.addPair(true, 0, 0);
  c.addPair(true, 1, 0);
  c.scene.pairs[0].number = 7;
  c.scene.pairs[1].number = 3;
  Left left(c);
  Touches yes(true), no(false);
  EXPECT_TRUE(left(&yes).empty());
  ASSERT_EQ(yes.numbers, std::vector<std::uint32_t>{7});
  EXPECT_NEAR(yes.times[0], 0.5, 0.2);
  EXPECT_EQ(left(&no), std::vector<std::uint32_t>{7});
  EXPECT_EQ(no.numbers, std::vector<std::uint32_t>{7});
  EXPECT_EQ(left(nullptr), std::vector<std::uint32_t>{7});
}

TEST(ChainFilter, DoesNotTestPairsThatAreProved) {
  Case c;
  c.addJoint(kNone, true, {}, Vec3::UnitX(), 0, 1);
  for (int i = 0; i < 3; ++i)
    c.addLink(i == 0 ? 0 : kNone, {}, c.hullOf(placed(Box{Vec3(0.2, 0.2, 0.2)}, {})));
  c.addPair(false, 1, 0);
  c.addPair(false, 2, 0);
  c.scene.pairs[0].number = 7;
  c.scene.pairs[1].number = 3;
  Left left(c);
  std::vector<std::uint8_t> proved(8, 0);
  EXPECT_EQ(left(nullptr, proved), (std::vector<std::uint32_t>{3, 7}));
  proved[7] = 1;
  EXPECT_EQ(left(nullptr, proved), std::vector<std::uint32_t>{3});
}

TEST(ChainFilter, TestsLinksAtRest) {
  Case c;
  c.addJoint(kNone, true, {}, Vec3::UnitX(), 0, 1);
  for (int i = 0; i < 2; ++i) c.addLink(kNone, {}, c.hullOf(placed(Box{Vec3(0.2, 0.2, 0.2)}, {})));
  for (const double x : {0.1, 3.0})
    c.addObstacle(false, {Mat3::Identity(), Vec3(x, 0, 0)}, Vec3(0.1, 0.1, 0.1));
  c.addPair(true, 0, 0);
  c.addPair(true, 1, 0);
  c.addPair(false, 0, 1);
  EXPECT_EQ(leftOf(ChainFilter(c.scene), c, {0, 0, 0}), (std::vector<std::uint32_t>{0, 2}));
}

TEST(ChainFilter, ProvesNothingForNumbersThatItIsNotMadeFor) {
  Random random(test::testSeed(75));
  const Case good = randomCase(random, 0.1, 0);
  const std::vector<double> margins(good.scene.pairs.size(), 0);
  const ChainFilter filter(good.scene);
  EXPECT_LT(leftOf(filter, good, margins).size(), margins.size());
  for (const double wrong : {std::nan(""), HUGE_VAL, 1e9}) {
    for (double JointMotion::*member :
         {&JointMotion::angle, &JointMotion::rate, &JointMotion::largestRate, &JointMotion::tube,
          &JointMotion::length, &JointMotion::rotationError, &JointMotion::shiftError}) {
      Case c = good;
      c.motions[1].*member = wrong;
      EXPECT_EQ(leftOf(filter, c, margins).size(), margins.size());
    }
    Case c = good;
    c.motions[2].shift[1] = wrong;
    EXPECT_EQ(leftOf(filter, c, margins).size(), margins.size());
    c = good;
    c.scene.obstacles[0].X_WO.t[0] = wrong;
    EXPECT_FALSE(ChainFilter::isUsable(c.scene));
    EXPECT_THROW(ChainFilter{c.scene}, std::invalid_argument);
    c = good;
    c.scene.links[0].center[0] = wrong;
    EXPECT_FALSE(ChainFilter::isUsable(c.scene));
  }
  Case loop = good;
  loop.scene.joints[0].parent = 0;
  EXPECT_FALSE(ChainFilter::isUsable(loop.scene));
  Case many = good;
  many.scene.joints.resize(65);
  EXPECT_FALSE(ChainFilter::isUsable(many.scene));
}

}  // namespace
}  // namespace chain_filter
}  // namespace corridor
