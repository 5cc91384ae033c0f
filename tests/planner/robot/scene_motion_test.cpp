// Tests of scenes of many moving frames: although a scene leaves out pairs that are far apart, its
// verdict must be the same as if every pair were tested alone.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "collision/motion/check_certificate.h"
#include "collision/world/body_queries.h"
#include "planner/robot/edge_motion.h"
#include "tests/planner/robot/random_trees.h"
#include "tests/support/meshes.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::RandomTrees;

/// Returns a scene with one body on every frame that moves, and some bodies fixed in the world. Its
/// pairs are all pairs of bodies on different frames.
Scene randomScene(RandomTrees& random) {
  std::vector<Scene::Placed> bodies;
  const auto box = [&](double size) {
    const Vec3 half = size * Vec3(random.real(0.2, 1), random.real(0.2, 1), random.real(0.2, 1));
    const Vec3 center = random.vector(0.3);
    return Body("", test::box(center - half, center + half));
  };
  const std::size_t obstacles = 1 + random.randomIndex(4);
  for (std::size_t i = 0; i < obstacles; ++i) {
    const Vec3 center = random.vector(2);
    const Vec3 half(random.real(0.1, 1), random.real(0.1, 1), random.real(0.1, 1));
    bodies.push_back({Body("", test::box(center - half, center + half)), 0});
  }
  for (std::size_t frame = 1; frame < random.tree.frames.size(); ++frame)
    if (!random.oneIn(3)) bodies.push_back({box(0.15), frame});
  std::vector<Scene::Pair> pairs;
  for (std::size_t a = 0; a < bodies.size(); ++a)
    for (std::size_t b = a + 1; b < bodies.size(); ++b)
      if (bodies[a].frame != bodies[b].frame && random.oneIn(3)) pairs.push_back({a, b});
  return {std::move(bodies), std::move(pairs)};
}

std::optional<Contact> firstTouching(const Scene& scene, std::span<const Transform> X_WF,
                                     QueryContext& context) {
  for (const Scene::Pair& pair : scene.pairs()) {
    const Scene::Placed &a = scene.bodies()[pair.a], &b = scene.bodies()[pair.b];
    if (const auto hit =
            interference(Posed(a.body, X_WF[a.frame]), Posed(b.body, X_WF[b.frame]), context))
      return Contact{pair.a, pair.b, hit->a, hit->b};
  }
  return std::nullopt;
}

/// Returns the scene's pairs without the scene's data about the motion of bodies in the world.
std::vector<MotionPair> pairsAlone(const Scene& scene) {
  std::vector<MotionPair> pairs;
  const std::vector<Scene::FramePair>& frames = scene.framePairs();
  for (const Scene::Pair& pair : scene.pairs()) {
    const Scene::Placed &a = scene.bodies()[pair.a], &b = scene.bodies()[pair.b];
    const auto motion = std::find_if(frames.begin(), frames.end(), [&](const Scene::FramePair& f) {
      return f.a == a.frame && f.b == b.frame;
    });
    pairs.push_back(
        {&a.body, &b.body, static_cast<std::size_t>(motion - frames.begin()), pair.a, pair.b});
  }
  return pairs;
}

TEST(SceneMotion, EdgesOfRandomTrees) {
  RandomTrees random(test::testSeed(81));
  QueryContext context, other;
  int free = 0, contact = 0, undecided = 0;
  std::uint64_t poses = 0, posesAlone = 0;
  const int count = (test::isStressRun() ? 30'000 : 3'000) / test::kSlowdown;
  for (int n = 0; n < count; ++n) {
    random.makeTree(2 + random.randomIndex(7));
    const Scene scene = randomScene(random);
    if (scene.pairs().empty()) continue;
    EdgeMotion motion(random.tree, random.space, scene.framePairs(), random.noTube());
    const std::vector<MotionPair> alone = pairsAlone(scene);
    MotionOptions options;
    options.tolerance = 1e-8;
    options.margin = n % 3 ? 0 : random.real(0, 0.1);
    options.earliest = n % 5 == 0;
    for (int k = 0; k < 4; ++k) {
      random.makeEdge(std::pow(10.0, random.real(-2, 0.7)));
      motion.set(random.from, random.to);
      const std::uint64_t before = context.counters.poses, beforeAlone = other.counters.poses;
      const MotionResult answer = scene.certify(motion, options, context);
      const MotionResult byPairs = certifyMotion(motion, alone, options, other);
      poses += context.counters.poses - before;
      posesAlone += other.counters.poses - beforeAlone;
      undecided += answer.verdict == MotionVerdict::undecided;
      if (answer.verdict == MotionVerdict::undecided || byPairs.verdict == MotionVerdict::undecided)
        continue;
      ASSERT_EQ(answer.verdict, byPairs.verdict) << n << ", edge " << k;
      free += answer.verdict == MotionVerdict::free;
      contact += answer.verdict == MotionVerdict::contact;
      if (answer.verdict == MotionVerdict::contact && options.earliest) {
        // The interval [certifiedUntil, time] of each answer contains the first contact.
        EXPECT_LE(answer.certifiedUntil, byPairs.time) << n;
        EXPECT_LE(byPairs.certifiedUntil, answer.time) << n;
      }
      if (answer.verdict != MotionVerdict::free || motion.ambiguous()) continue;
      for (const double t : {0.0, 0.17, 0.5, 0.83, 1.0}) {
        for (const MotionPair& pair : alone)
          ASSERT_FALSE(interference(
              Posed(*pair.a), Posed(*pair.b, motion.relativeMotion(pair.motion, t, 0).X_AB), other))
              << n << ", edge " << k << " at " << t;
      }
    }
  }
  std::cout << "free " << free << ", contact " << contact << ", undecided " << undecided
            << "; time intervals " << poses << ", if tested pair by pair " << posesAlone << "\n";
  EXPECT_GT(free, count / 10);
  EXPECT_GT(contact, count / 10);
  EXPECT_LE(undecided, 1 + count / 100);
  EXPECT_LT(poses, posesAlone);
}

/// `checkCertificate` accepts the certificates of scenes, including pairs that the scene left out
/// by its own bounds.
TEST(SceneMotion, CertificateHolds) {
  RandomTrees random(test::testSeed(83));
  QueryContext context;
  int free = 0, contact = 0, unproved = 0;
  std::size_t intervals = 0;
  const int count = (test::isStressRun() ? 3'000 : 300) / test::kSlowdown;
  for (int n = 0; n < count; ++n) {
    random.makeTree(2 + random.randomIndex(5));
    const Scene scene = randomScene(random);
    if (scene.pairs().empty()) continue;
    EdgeMotion motion(random.tree, random.space, scene.framePairs(), random.noTube());
    MotionOptions options;
    options.tolerance = 1e-6;
    options.clearanceSlack = 1e-6;
    options.margin = n % 3 ? 0 : random.real(0, 0.05);
    options.earliest = n % 2 == 0;
    random.makeEdge(std::pow(10.0, random.real(-2, 0.3)));
    motion.set(random.from, random.to);
    MotionCertificate certificate;
    const MotionResult answer = scene.certify(motion, options, context, certificate);
    ASSERT_EQ(answer.verdict, scene.certify(motion, options, context).verdict);
    if (answer.verdict == MotionVerdict::undecided) continue;
    const double until = answer.verdict == MotionVerdict::free ? 1 : answer.certifiedUntil;
    free += answer.verdict == MotionVerdict::free;
    contact += answer.verdict == MotionVerdict::contact;
    EXPECT_EQ(certificate.point_A.has_value(), answer.verdict == MotionVerdict::contact);
    intervals += certificate.free.size();
    const auto fault =
        checkCertificate(motion, scene.motionPairs(), options, until, certificate, context);
    // The isotropic bound of `checkCertificate` may be too weak for long chains.
    unproved += fault && fault->kind == CertificateFault::Kind::unproved;
    ASSERT_TRUE(!fault || fault->kind == CertificateFault::Kind::unproved)
        << n << ": " << static_cast<int>(fault->kind) << " of pair " << fault->pair << " at "
        << fault->t;
    // A certificate from which an interval was removed must be refused.
    if (until == 0 || certificate.free.empty()) continue;
    certificate.free.erase(
        certificate.free.begin() +
        static_cast<std::ptrdiff_t>(random.randomIndex(certificate.free.size())));
    const auto missed =
        checkCertificate(motion, scene.motionPairs(), options, 1, certificate, context);
    EXPECT_TRUE(missed) << n;
  }
  std::cout << free << " free and " << contact << " contacts proved anew by " << intervals
            << " intervals, " << unproved << " not for rounding alone\n";
  EXPECT_GT(free, count / 10);
  EXPECT_GT(contact, count / 20);
  EXPECT_LE(unproved, count / 50);
}

TEST(SceneMotion, StatesOfRandomTrees) {
  RandomTrees random(test::testSeed(82));
  QueryContext context;
  int touching = 0, apart = 0;
  const int count = (test::isStressRun() ? 30'000 : 3'000) / test::kSlowdown;
  for (int n = 0; n < count; ++n) {
    random.makeTree(2 + random.randomIndex(7));
    const Scene scene = randomScene(random);
    random.makeEdge(1);
    std::vector<Transform> X_WF = framePoses(random.tree, random.from);
    // In some cases the maps are rigid only to four digits, or all of them are given in a shifted
    // world frame.
    if (n % 3 == 0)
      for (Transform& X : X_WF) X.m *= 1 + 1e-4 * random.real();
    if (n % 4 == 0)
      for (Transform& X : X_WF) X.t += Vec3(5, -3, 2);
    const auto hit = scene.interference(X_WF, context);
    const auto expected = firstTouching(scene, X_WF, context);
    ASSERT_EQ(hit.has_value(), expected.has_value()) << n;
    (hit ? touching : apart) += 1;
    double least = HUGE_VAL;
    for (const Scene::Pair& pair : scene.pairs()) {
      const Scene::Placed &a = scene.bodies()[pair.a], &b = scene.bodies()[pair.b];
      least = std::min(
          least, distance(Posed(a.body, X_WF[a.frame]), Posed(b.body, X_WF[b.frame]), {}, context)
                     .distance);
    }
    const double clearance = scene.clearance(X_WF, context);
    if (least < HUGE_VAL) {
      // Each of the two distances is within the error that queries/distance.h promises: 1e-12·d +
      // 4·2^-53·S. Here S < 100.
      EXPECT_NEAR(clearance, least, 2e-12 * least + 1e-13) << n;
    } else {
      EXPECT_EQ(clearance, least);
    }
  }
  std::cout << touching << " touching, " << apart << " apart\n";
  EXPECT_GT(touching, count / 10);
  EXPECT_GT(apart, count / 10);
}

/// Obstacles on frames of their own, which share one mesh. Whether or not the scene knows that
/// these frames are at rest, all answers must be the same.
struct Crowd {
  std::vector<RigidPose> poses;
  TriangleMesh mesh;
  std::optional<ConvexPart> part;  // if set, the obstacles have this shape instead of the mesh
  std::vector<TriangleMesh> links;
};

Scene crowded(const RandomTrees& random, const Crowd& crowd, std::size_t firstOwn, bool known) {
  const Body first = crowd.part ? Body("", *crowd.part) : Body("", crowd.mesh, true);
  const std::vector<Transform> X_WF = framePoses(random.tree, random.from);
  std::vector<Scene::Placed> bodies;
  for (std::size_t i = 0; i < crowd.poses.size(); ++i) {
    const std::size_t frame = firstOwn + i;
    bodies.push_back(
        {first.renamed("obstacle"), frame, known ? std::optional(X_WF[frame]) : std::nullopt});
  }
  for (std::size_t i = 0; i < crowd.links.size(); ++i)
    bodies.push_back({Body("", crowd.links[i]), i + 1});
  const TriangleMesh ground = test::box(Vec3(-9, -9, -2.1), Vec3(9, 9, -2));
  for (int i = 0; i < 3; ++i) bodies.push_back({Body("", ground), 0});
  std::vector<Scene::Pair> pairs;
  const std::size_t own = crowd.poses.size(), links = crowd.links.size();
  for (std::size_t b = own; b < own + links; ++b)
    for (std::size_t a = 0; a < bodies.size(); ++a)
      if (a < b || a >= own + links) pairs.push_back({a, b});
  return {std::move(bodies), std::move(pairs)};
}

TEST(SceneMotion, FramesAtRestChangeNoAnswer) {
  RandomTrees random(test::testSeed(84));
  QueryContext context, other;
  std::map<MotionVerdict, int> verdicts;
  int touching = 0, apart = 0;
  std::uint64_t poses = 0, posesOther = 0;
  const int count = (test::isStressRun() ? 4'000 : 400) / test::kSlowdown;
  for (int n = 0; n < count; ++n) {
    random.makeTree(1 + random.randomIndex(4), 0.3);
    Crowd crowd;
    const Vec3 half(random.real(0.05, 0.3), random.real(0.05, 0.3), random.real(0.05, 0.3));
    crowd.mesh = test::box(-half, half);
    if (n % 4 == 0) crowd.part = placed(Capsule{half.x(), 0.5 * half.y()}, {});
    for (std::size_t f = 1; f < random.tree.frames.size(); ++f)
      crowd.links.push_back(test::box(Vec3(-0.1, -0.05, -0.05), Vec3(0.1, 0.05, 0.05)));
    const std::size_t firstOwn = random.tree.frames.size();
    // With 32 obstacles or more, the broad phase has a tree of their boxes.
    for (const std::size_t many = random.oneIn(2) ? 4 : 40; crowd.poses.size() < many;) {
      const double size = std::pow(10.0, random.real(-1, 1));
      const Eigen::Quaterniond q(size * random.real(), size * random.real(), size * random.real(),
                                 size * random.real());
      crowd.poses.push_back({random.vector(4), q});
      Frame frame;
      frame.fixed = crowd.poses.back();
      random.tree.add(frame);
    }
    random.makeEdge(std::pow(10.0, random.real(-2, 0.5)));
    const Scene scene = crowded(random, crowd, firstOwn, true),
                plain = crowded(random, crowd, firstOwn, false);
    EXPECT_EQ(&scene.bodies()[0].body.tree(), &scene.bodies()[3].body.tree());
    EdgeMotion motion(random.tree, random.space, scene.framePairs(), random.noTube()),
        plainMotion(random.tree, random.space, plain.framePairs(), random.noTube());
    MotionOptions options;
    options.tolerance = 1e-8;
    options.margin = n % 3 ? 0 : random.real(0, 0.1);
    options.earliest = n % 5 == 0;
    motion.set(random.from, random.to);
    plainMotion.set(random.from, random.to);
    const std::uint64_t before = context.counters.poses, beforeOther = other.counters.poses;
    const MotionVerdict verdict = scene.certify(motion, options, context).verdict,
                        expected = plain.certify(plainMotion, options, other).verdict;
    poses += context.counters.poses - before;
    posesOther += other.counters.poses - beforeOther;
    ++verdicts[expected];
    const auto decided = [](MotionVerdict v) { return v != MotionVerdict::undecided; };
    if (decided(verdict) && decided(expected)) {
      ASSERT_EQ(verdict, expected) << n;
    }
    MotionCertificate certificate;
    EXPECT_EQ(scene.certify(motion, options, context, certificate).verdict, verdict) << n;
    const auto each = scene.certifyEachPair(motion, options, context),
               plainEach = plain.certifyEachPair(plainMotion, options, other);
    // The two scenes sort the same pairs in different orders.
    const auto byBodies = [](const Scene& of, const std::vector<MotionResult>& results) {
      std::map<std::pair<std::size_t, std::size_t>, MotionVerdict> verdictOf;
      for (std::size_t k = 0; k < results.size(); ++k)
        verdictOf[std::minmax({of.pairs()[k].a, of.pairs()[k].b})] = results[k].verdict;
      return verdictOf;
    };
    const auto plainVerdicts = byBodies(plain, plainEach);
    for (const auto& [bodies, own] : byBodies(scene, each))
      if (const MotionVerdict same = plainVerdicts.at(bodies); decided(own) && decided(same)) {
        ASSERT_EQ(own, same) << n << ", bodies " << bodies.first << " and " << bodies.second;
      }
    std::vector<Transform> X_WF = framePoses(random.tree, random.to);
    const auto hit = scene.interference(X_WF, context), plainHit = plain.interference(X_WF, other);
    ASSERT_EQ(hit.has_value(), plainHit.has_value()) << n;
    ++(hit ? touching : apart);
    const double clearance = scene.clearance(X_WF, context);
    EXPECT_NEAR(clearance, plain.clearance(X_WF, other), 1e-12 * clearance + 1e-13) << n;
    for (std::size_t f = firstOwn; f < X_WF.size(); ++f) X_WF[f].t.x() = std::nan("");
    EXPECT_EQ(scene.interference(X_WF, context).has_value(), hit.has_value()) << "not used";
    EXPECT_EQ(scene.clearance(X_WF, context), clearance) << "not used";
  }
  std::cout << "free " << verdicts[MotionVerdict::free] << ", contact "
            << verdicts[MotionVerdict::contact] << ", undecided "
            << verdicts[MotionVerdict::undecided] << "; states: " << touching << " touching, "
            << apart << " apart; motions " << poses << ", else " << posesOther << "\n";
  EXPECT_GT(verdicts[MotionVerdict::free], count / 10);
  EXPECT_GT(verdicts[MotionVerdict::contact], count / 10);
  EXPECT_GT(touching, count / 10);
  EXPECT_GT(apart, count / 10);
  EXPECT_LT(2 * poses, posesOther);
}

}  // namespace
}  // namespace corridor
