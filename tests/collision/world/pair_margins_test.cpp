// Tests of margins that differ from pair to pair. A cube slides past a row of boxes, each at a
// known distance. So it is known which margins the motion keeps.
#include <algorithm>
#include <optional>
#include <random>
#include <string>
#include <utility>
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
  /// Returns the distance that the cube keeps from the box of a pair.
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
  const int count = casesOf(8, 60);
  int free = 0, notFree = 0;
  for (int n = 0; n < count; ++n) {
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
         {EdgeMethod::certified, EdgeMethod::adaptive, EdgeMethod::advancement}) {
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
    // Cubes are their own hulls, which decide nearly all pairs.
    QueryContext fresh;
    const std::vector<std::uint32_t> left = row.scene().pairsLeftByHulls(edge, options, fresh);
    EXPECT_LE(left.size(), 2u) << "case " << n;
    if (tooClose < row.size()) {
      EXPECT_NE(std::find(left.begin(), left.end(), tooClose), left.end()) << "case " << n;
    }
    // Without hulls, more pairs are left, and that one among them.
    options.hulls = false;
    const std::vector<std::uint32_t> more = row.scene().pairsLeftByHulls(edge, options, fresh);
    EXPECT_TRUE(std::includes(more.begin(), more.end(), left.begin(), left.end()));
    EXPECT_EQ(fresh.counters.boxTests, 0u) << "no tree is walked";
    options.hulls = true;
    options.clearanceSlack = 0.5;  // more than every gap
    EXPECT_EQ(row.scene().pairsLeftByHulls(edge, options, fresh).size(), row.size());
  }
  EXPECT_EQ(free, 3 * count / 2);
  EXPECT_EQ(notFree, 3 * count / 2);
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
  for (double& margin : metres) margin *= 1.2;
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
    EXPECT_THROW(row.scene().pairsWithin(std::vector<Transform>(2), margins, {}, context, {}),
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
      const auto near = row.scene().pairsWithin(X_WF, PairMargins(metres), {}, context, {});
      const std::vector<std::uint32_t> only = {1, 2};
      const auto some = row.scene().pairsWithin(X_WF, PairMargins(metres), {}, context, {&only});
      ASSERT_EQ(some.size(), share > 1 ? 1u : 0u);
      if (share > 1) {
        EXPECT_EQ(some.front().pair, 2u);
      }
      EXPECT_TRUE(
          row.scene().pairsWithin(X_WF, PairMargins(metres), {}, context, {&only, 0.9}).empty());
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

/// A link of two cubes between two walls, with the distance of every pair. The given pairs are not
/// in the scene's order: the scene puts the pairs of one cube side by side.
class LinkBetweenWalls {
 public:
  LinkBetweenWalls() : scene_(makeScene()) {}

  const Scene& scene() const { return scene_; }
  static double gapOf(std::size_t wall, std::size_t cube) {
    return cube == 2 ? (wall == 0 ? 0.9 : 1.4) : (wall == 0 ? 0.8 : 1.3);
  }
  MotionResult certify(const PairMargins& margins, MotionCertificate* certificate = nullptr) const {
    RigidEdge edge(RigidMotion::spatial(at(Vec3(0, 0, 0)), at(Vec3(1, 0, 0)), {}));
    QueryContext context;
    const MotionOptions options = optionsWith(margins, 0);
    return certificate ? scene_.certify(edge, options, context, *certificate)
                       : scene_.certify(edge, options, context);
  }
  std::vector<MotionResult> certifyEachPair(const PairMargins& margins) const {
    RigidEdge edge(RigidMotion::spatial(at(Vec3(0, 0, 0)), at(Vec3(1, 0, 0)), {}));
    QueryContext context;
    return scene_.certifyEachPair(edge, optionsWith(margins, 0), context);
  }

 private:
  static Scene makeScene() {
    std::vector<Scene::Placed> bodies;
    bodies.push_back({bodyOf(box(Vec3(-1, 1, -1), Vec3(2, 1.2, 3))), 0});             // wall 0
    bodies.push_back({bodyOf(box(Vec3(-1, -1.7, -1), Vec3(2, -1.5, 3))), 0});         // wall 1
    bodies.push_back({bodyOf(box(Vec3(-0.1, -0.1, -0.1), Vec3(0.1, 0.1, 0.1))), 1});  // cube 2
    bodies.push_back({bodyOf(box(Vec3(-0.1, -0.2, 1.9), Vec3(0.1, 0.2, 2.1))), 1});   // cube 3
    return {std::move(bodies), {{0, 2}, {0, 3}, {1, 2}, {1, 3}}};
  }

  Scene scene_;
};

/// Margins that are built in the order of `pairs()`, and margins that are built in the order of
/// `motionPairs()`, must be the same margins, and give the right verdict.
TEST(PairMargins, PairsAndMotionPairsHaveOneOrder) {
  const LinkBetweenWalls link;
  const Scene& scene = link.scene();
  ASSERT_EQ(scene.pairs().size(), 4u);
  ASSERT_EQ(scene.motionPairs().size(), 4u);
  for (std::size_t tooClose = 0; tooClose <= 4; ++tooClose) {
    // The margin of pair `tooClose`, if there is one, exceeds its gap; the others are far less.
    const auto metresOf = [&](std::size_t pair, std::size_t a, std::size_t b) {
      return (pair == tooClose ? 1.05 : 0.5) * LinkBetweenWalls::gapOf(a, b);
    };
    std::vector<double> byPairs, byMotionPairs;
    for (std::size_t i = 0; i < 4; ++i) {
      const Scene::Pair& pair = scene.pairs()[i];
      byPairs.push_back(metresOf(i, pair.a, pair.b));
      const MotionPair& moved = scene.motionPairs()[i];
      byMotionPairs.push_back(metresOf(i, moved.bodyA, moved.bodyB));
      EXPECT_EQ(&scene.bodies()[pair.a].body, moved.a);
      EXPECT_EQ(&scene.bodies()[pair.b].body, moved.b);
    }
    EXPECT_EQ(byPairs, byMotionPairs);
    for (const std::vector<double>& metres : {byPairs, byMotionPairs}) {
      const PairMargins margins(metres);
      const MotionResult result = link.certify(margins);
      ASSERT_EQ(result.verdict == MotionVerdict::free, tooClose == 4) << "pair " << tooClose;
      const std::vector<MotionResult> each = link.certifyEachPair(margins);
      for (std::size_t i = 0; i < 4; ++i)
        EXPECT_EQ(each[i].verdict != MotionVerdict::free, i == tooClose) << "pair " << i;
      MotionCertificate certificate;
      link.certify(margins, &certificate);
      for (const FreeInterval& proved : certificate.free) {
        const Scene::Pair& pair = scene.pairs()[proved.pair];
        EXPECT_LE(proved.clearance, LinkBetweenWalls::gapOf(pair.a, pair.b));
        EXPECT_GE(proved.clearance, metres[proved.pair]);
      }
    }
  }
}

/// Random scenes: the sorted pairs are the given pairs, with a and b exchanged where the header
/// says so, and all queries number them alike.
TEST(PairMargins, SortedPairsAreTheGivenPairs) {
  std::mt19937_64 random(testSeed(2502));
  for (int n = 0; n < 200; ++n) {
    std::vector<Scene::Placed> bodies;
    const std::size_t count = 3 + random() % 8, frames = 1 + random() % 4;
    const Body cube = bodyOf(box(Vec3(0, 0, 0), Vec3(1, 1, 1)));
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t frame = random() % (frames + 1);
      const bool rests = frame > 0 && random() % 4 == 0;
      bodies.push_back({cube.renamed(std::to_string(i)), rests ? frame + 10 : frame,
                        rests ? std::optional(Transform()) : std::nullopt});
    }
    std::vector<Scene::Pair> given;
    std::vector<std::pair<std::size_t, std::size_t>> wanted, sorted;
    for (std::size_t a = 0; a < count; ++a)
      for (std::size_t b = a + 1; b < count; ++b) {
        if (bodies[a].frame == bodies[b].frame || random() % 3 == 0) continue;
        given.push_back(random() % 2 ? Scene::Pair{a, b} : Scene::Pair{b, a});
        wanted.emplace_back(a, b);
      }
    std::shuffle(given.begin(), given.end(), random);
    const Scene scene(std::move(bodies), given);
    ASSERT_EQ(scene.pairs().size(), given.size());
    ASSERT_EQ(scene.motionPairs().size(), given.size());
    for (std::size_t i = 0; i < given.size(); ++i) {
      const auto [a, b] = scene.pairs()[i];
      const MotionPair& moved = scene.motionPairs()[i];
      ASSERT_EQ(a, moved.bodyA);
      ASSERT_EQ(b, moved.bodyB);
      const Scene::FramePair& frame = scene.framePairs()[moved.motion];
      ASSERT_EQ(frame.a, scene.bodies()[a].frame);
      ASSERT_EQ(frame.b, scene.bodies()[b].frame);
      sorted.emplace_back(std::min(a, b), std::max(a, b));
    }
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(sorted, wanted);
  }
}

}  // namespace
}  // namespace corridor::test
