// Tests of margins that differ from pair to pair. A cube slides past a row of boxes, each at a
// known distance. So it is known which margins the motion keeps.
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "collision/motion/check_certificate.h"
#include "collision/world/rigid_scene.h"
#include "tests/collision/motion/bodies.h"
#include "tests/support/support.h"

namespace corridor::test {
namespace {

constexpr double kTolerance = 1e-6;

/// A cube of edge length 0.2 m that slides along x, and boxes above its way.
class Row {
 public:
  explicit Row(std::vector<double> gaps) : gaps_(std::move(gaps)), scene_(sceneOf(gaps_)) {}

  const Scene& scene() const { return scene_.scene(); }
  std::size_t size() const { return gaps_.size(); }
  /// Returns the distance that the cube keeps from the box of a pair of `motionPairs()`.
  double gapOf(std::size_t pair) const { return gaps_[scene().motionPairs()[pair].bodyA]; }
  RigidMotion motion() const {
    const double end = 0.5 * static_cast<double>(size());
    return RigidMotion::spatial(at(Vec3(-0.5, 0, 0)), at(Vec3(end, 0, 0)), {});
  }

 private:
  static RigidScene sceneOf(const std::vector<double>& gaps) {
    std::vector<Body> cube, boxes;
    cube.push_back(bodyOf(box(Vec3(-0.1, -0.1, -0.1), Vec3(0.1, 0.1, 0.1))));
    for (std::size_t i = 0; i < gaps.size(); ++i) {
      const double x = 0.5 * static_cast<double>(i), y = 0.1 + gaps[i];
      boxes.push_back(bodyOf(box(Vec3(x, y, -0.1), Vec3(x + 0.1, y + 0.1, 0.1))));
    }
    return RigidScene(std::move(cube), std::move(boxes));
  }

  std::vector<double> gaps_;
  RigidScene scene_;
};

MotionOptions optionsWith(const PairMargins& margins, double margin) {
  MotionOptions options;
  options.tolerance = options.clearanceSlack = kTolerance;
  options.margin = margin;
  options.pairMargins = &margins;
  return options;
}

TEST(PairMargins, AMotionIsFreeIfEachPairKeepsItsOwn) {
  std::mt19937_64 random(testSeed(2501));
  std::uniform_real_distribution<double> anyGap(0.001, 0.4), share(0.2, 0.98);
  int free = 0, notFree = 0;
  for (int n = 0; n < 60; ++n) {
    std::vector<double> gaps(n % 3 == 0 ? 3 : 40);
    for (double& gap : gaps) gap = anyGap(random);
    const Row row(gaps);
    const double margin = n % 2 ? 0.0005 : 0;
    std::vector<double> metres;
    for (std::size_t k = 0; k < row.size(); ++k)
      metres.push_back(share(random) * (row.gapOf(k) - margin));
    // In half of the cases, one pair is too close.
    const std::size_t tooClose = n % 4 < 2 ? row.size() : random() % row.size();
    if (tooClose < row.size()) metres[tooClose] = 1.05 * row.gapOf(tooClose);
    const PairMargins margins(metres);
    MotionOptions options = optionsWith(margins, margin);
    for (const EdgeMethod method :
         {EdgeMethod::directional, EdgeMethod::adaptive, EdgeMethod::advancement}) {
      RigidEdge edge(row.motion());
      QueryContext context;
      const MotionResult result = row.scene().certify(edge, options, context, method);
      ASSERT_EQ(result.verdict == MotionVerdict::free, tooClose == row.size())
          << "case " << n << ", method " << static_cast<int>(method);
      if (result.verdict == MotionVerdict::free) {
        ++free;
        continue;
      }
      ++notFree;
      ASSERT_TRUE(result.pair);
      EXPECT_EQ(result.pair->bodyA, row.scene().motionPairs()[tooClose].bodyA);
    }
    RigidEdge edge(row.motion());
    QueryContext context;
    const std::vector<MotionResult> each = row.scene().certifyEachPair(edge, options, context);
    for (std::size_t i = 0; i < each.size(); ++i) {
      const bool close = tooClose < row.size() &&
                         row.scene().pairs()[i].a == row.scene().motionPairs()[tooClose].bodyA;
      EXPECT_EQ(each[i].verdict != MotionVerdict::free, close) << "pair " << i;
    }
  }
  EXPECT_GT(free, 50);
  EXPECT_GT(notFree, 50);
}

TEST(PairMargins, ACertificateProvesThem) {
  const Row row({0.05, 0.3, 0.1});
  std::vector<double> metres;
  for (std::size_t k = 0; k < row.size(); ++k) metres.push_back(0.9 * row.gapOf(k));
  const PairMargins margins(metres);
  const MotionOptions options = optionsWith(margins, 0);
  RigidEdge edge(row.motion());
  QueryContext context;
  MotionCertificate certificate;
  ASSERT_EQ(row.scene().certify(edge, options, context, certificate).verdict, MotionVerdict::free);
  const auto check = [&](const MotionCertificate& claims, const PairMargins& own) {
    return checkCertificate(edge, row.scene().motionPairs(), optionsWith(own, 0), 1, claims,
                            context);
  };
  EXPECT_FALSE(check(certificate, margins));
  for (FreeInterval& i : certificate.free) EXPECT_GE(i.clearance, metres[i.pair]);
  // The same intervals do not prove larger margins of pairs.
  for (double& margin : metres) margin *= 1.05;
  EXPECT_TRUE(check(certificate, PairMargins(metres)));
  // A certificate that claims less than the margins is refused, although the motion keeps the
  // margins.
  MotionCertificate modest = certificate;
  for (FreeInterval& i : modest.free) i.clearance = 0.01;
  EXPECT_TRUE(check(modest, margins));
  // A claim that exceeds the true clearance a little is refused, although most claims are far below
  // the largest margin.
  MotionCertificate bold = certificate;
  for (std::size_t k = 0; k < row.size(); ++k) metres[k] = 1.01 * row.gapOf(k);
  for (FreeInterval& i : bold.free) i.clearance = metres[i.pair] + 2 * kTolerance;
  EXPECT_TRUE(check(bold, PairMargins(metres)));
}

TEST(PairMargins, RefusesWrongNumbers) {
  const Row row({0.05, 0.3});
  RigidEdge edge(row.motion());
  QueryContext context;
  for (const std::vector<double>& metres :
       {std::vector<double>{0.01, -1e-9}, {0.01, HUGE_VAL}, {std::nan(""), 0}})
    EXPECT_THROW(PairMargins{metres}, std::invalid_argument);
  for (const std::vector<double>& metres : {std::vector<double>{0.01}, {0.01, 0.01, 0.01}}) {
    const PairMargins margins(metres);
    EXPECT_THROW(row.scene().certify(edge, optionsWith(margins, 0), context),
                 std::invalid_argument);
    EXPECT_THROW(row.scene().pairsWithin(std::vector<Transform>(2), margins, {}, context),
                 std::invalid_argument);
    const auto fault =
        checkCertificate(edge, row.scene().motionPairs(), optionsWith(margins, 0), 0, {}, context);
    ASSERT_TRUE(fault);
    EXPECT_EQ(fault->kind, CertificateFault::Kind::malformed);
  }
}

/// The query must find the pairs that are closer than their margins, and their distances, which are
/// known in closed form.
TEST(PairMargins, FindsThePairsWithinThem) {
  const std::vector<double> gaps{0.05, 0.3, 0.1, 0.02};
  const Row row(gaps);
  QueryContext context;
  for (const double x : {0.05, 1.05, 7.0}) {
    std::vector<Transform> X_WF(2);
    X_WF[1].t = Vec3(x, 0, 0);
    for (const double share : {0.99, 1.01}) {
      // The distance of each box from the cube at x; the cube reaches from x − 0.1 to x + 0.1.
      std::vector<double> distances, metres;
      for (std::size_t k = 0; k < row.size(); ++k) {
        const double left = 0.5 * static_cast<double>(row.scene().motionPairs()[k].bodyA);
        const double aside = std::max({0.0, left - (x + 0.1), x - 0.1 - (left + 0.1)});
        distances.push_back(std::hypot(aside, row.gapOf(k)));
        metres.push_back(k == 1 ? 0 : share * distances.back());
      }
      const auto near = row.scene().pairsWithin(X_WF, PairMargins(metres), {}, context);
      ASSERT_EQ(near.size(), share > 1 ? 3u : 0u);
      std::size_t before = 0;
      for (const Scene::NearPair& pair : near) {
        EXPECT_NE(pair.pair, 1u);
        EXPECT_TRUE(&pair == near.data() || pair.pair > before);
        before = pair.pair;
        EXPECT_NEAR(pair.distance.distance, distances[pair.pair], 1e-14);
        EXPECT_NEAR((pair.distance.p_WA - pair.distance.p_WB).norm(), distances[pair.pair], 1e-14);
      }
    }
  }
}

}  // namespace
}  // namespace corridor::test
