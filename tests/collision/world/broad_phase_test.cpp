// Compares scenes of many bodies with the same queries without a broad phase: the broad phase must
// not change any answer.
#include "collision/motion/broad_phase.h"

#include <map>
#include <random>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "collision/queries/distance.h"
#include "collision/queries/interference.h"
#include "collision/world/body_queries.h"
#include "collision/world/rigid_scene.h"
#include "tests/collision/motion/bodies.h"
#include "tests/support/soups.h"
#include "tests/support/support.h"

namespace corridor::test {
namespace {

Body translated(const TriangleMesh& mesh, const Vec3& by, bool solid) {
  TriangleMesh moved = mesh;
  for (Vec3& vertex : moved.vertices) vertex += by;
  return Body("", std::move(moved), solid);
}

/// Returns a scene of two moving bodies among many obstacles: blobs, boxes (solid on request) and
/// convex parts.
RigidScene crowd(std::mt19937_64& random, int count, bool solids) {
  std::vector<Body> moving, fixed;
  moving.push_back(bodyOf(blob(random, 20, 0.2, 0.2)));
  moving.push_back(
      translated(box(Vec3(-0.1, -0.1, -0.1), Vec3(0.1, 0.1, 0.1)), Vec3(0.4, 0, 0), solids));
  const TriangleMesh cube = box(Vec3(-0.15, -0.1, -0.05), Vec3(0.15, 0.1, 0.05));
  const TriangleMesh hall = box(Vec3(-0.9, -0.9, -0.9), Vec3(0.9, 0.9, 0.9));
  const std::vector<ConvexPart> shapes = parts(random, count, 0.2);
  for (int i = 0; i < count; ++i) {
    const Vec3 where = 4 * randomInCube(random);
    if (i % 3 == 0) fixed.push_back(bodyOf(blob(random, 5, 0.1, 0.1)));
    if (i % 3 == 1) fixed.push_back(translated(i % 12 == 1 ? hall : cube, where, solids));
    if (i % 3 == 2) {
      ConvexPart part = shapes.at(static_cast<std::size_t>(i));
      for (Vec3& p : part.points) p += where;
      fixed.emplace_back("", std::move(part));
    }
  }
  return RigidScene(std::move(moving), std::move(fixed));
}

bool sameAnswer(const MotionResult& a, const MotionResult& b) {
  return a.verdict == b.verdict && a.reason == b.reason && a.certifiedUntil == b.certifiedUntil &&
         a.time == b.time && a.grazing == b.grazing && a.gap == b.gap &&
         a.pair.has_value() == b.pair.has_value() &&
         (!a.pair || (a.pair->bodyA == b.pair->bodyA && a.pair->bodyB == b.pair->bodyB));
}

TEST(BroadPhase, MotionsHaveTheSameAnswers) {
  std::mt19937_64 random(testSeed(242));
  std::map<MotionVerdict, int> verdicts;
  for (const int count : {5, 20, 200}) {
    const RigidScene scene = crowd(random, count, false);
    for (int n = 0; n < 300; ++n) {
      const auto [from, to] = randomEdge(random);
      MotionOptions options;
      options.tolerance = 1e-4;
      options.clearanceSlack = n % 2 ? 1e-4 : 0;
      options.margin = n % 4 == 0 ? 0.3 : 0;
      options.earliest = n % 3 == 0;
      RigidEdge edge(RigidMotion::spatial(from, to, {.position = 1e-6, .rotation = 1e-6}));
      QueryContext one, other;
      const MotionResult with = scene.scene().certify(edge, options, one);
      const MotionResult without = certifyMotion(edge, scene.scene().motionPairs(), options, other);
      EXPECT_TRUE(sameAnswer(with, without)) << count << " obstacles, edge " << n;
      // The broad phase may save tests: the box around several bodies may be separated, although
      // the bound of a single one of these bodies is too weak.
      EXPECT_LE(one.counters.boxTests, other.counters.boxTests);
      ++verdicts[with.verdict];
      std::map<MotionVerdict, int> each, alone;
      for (const MotionResult& result : scene.scene().certifyEachPair(edge, options, one))
        ++each[result.verdict];
      for (const MotionPair& pair : scene.scene().motionPairs())
        ++alone[certifyMotion(edge, {&pair, 1}, options, other).verdict];
      EXPECT_EQ(each, alone) << "the answers of single pairs";
      MotionCertificate certificate;
      const MotionResult proved = scene.scene().certify(edge, options, one, certificate);
      EXPECT_EQ(proved.verdict, with.verdict);
      if (with.verdict == MotionVerdict::free) {
        EXPECT_GE(certificate.free.size(), scene.scene().motionPairs().size());
      }
    }
  }
  EXPECT_GT(verdicts[MotionVerdict::free], 20);
  EXPECT_GT(verdicts[MotionVerdict::contact], 20);
}

/// Containment is tested only for the pairs that the broad phase finds at the start of the motion.
/// These must include all bodies inside solids.
TEST(BroadPhase, FindsBodiesInsideSolids) {
  std::mt19937_64 random(testSeed(243));
  int inside = 0, free = 0;
  for (int scenes = 0; scenes < 4; ++scenes) {
    const RigidScene scene = crowd(random, 60, true);
    for (int n = 0; n < 300; ++n) {
      const auto [from, to] = randomEdge(random);
      MotionOptions options;
      options.tolerance = 1e-4;
      options.earliest = n % 3 == 0;
      RigidEdge edge(RigidMotion::spatial(from, n % 2 ? to : from, {}));
      QueryContext context;
      const MotionResult all = scene.scene().certify(edge, options, context);
      const auto each = scene.scene().certifyEachPair(edge, options, context);
      ASSERT_EQ(each.size(), scene.scene().pairs().size());
      MotionVerdict worst = MotionVerdict::free;
      for (const MotionResult& one : each)
        if (one.verdict != MotionVerdict::free && worst != MotionVerdict::contact)
          worst = one.verdict;
      EXPECT_EQ(all.verdict, worst) << "scene " << scenes << ", edge " << n;
      // The expected answer is computed by a test of each pair of bodies at the start.
      const Transform X_WB = RigidMotion::spatial(from, from, {}).at(0);
      bool touches = false;
      for (const Scene::Pair& pair : scene.scene().pairs())
        touches = touches || interference(Posed(scene.scene().bodies()[pair.a].body),
                                          Posed(scene.scene().bodies()[pair.b].body, X_WB), context)
                                 .has_value();
      if (touches) {
        EXPECT_EQ(all.certifiedUntil, 0) << n;
      }
      if (all.verdict == MotionVerdict::free) {
        EXPECT_FALSE(touches) << n;
      } else if (n % 2 == 0) {
        EXPECT_EQ(all.verdict == MotionVerdict::contact, touches) << n;
      }
      free += all.verdict == MotionVerdict::free;
      inside += all.verdict == MotionVerdict::contact &&
                certifyMotion(edge, scene.scene().motionPairs(), options, context).verdict ==
                    MotionVerdict::free;
    }
  }
  EXPECT_GT(inside, 5) << "a body inside a solid, whose surfaces don't touch";
  EXPECT_GT(free, 20);
}

/// A cube starts inside a solid hall, and leaves the hall. The broad phase must find the hall at
/// the start.
TEST(BroadPhase, FindsTheSolidThatABodyLeaves) {
  std::vector<Body> moving, fixed;
  const TriangleMesh cube = box(Vec3(-0.1, -0.1, -0.1), Vec3(0.1, 0.1, 0.1));
  moving.push_back(bodyOf(cube));
  fixed.push_back(translated(box(Vec3(-1, -1, -1), Vec3(1, 1, 1)), Vec3::Zero(), true));
  for (int i = 0; i < 40; ++i) fixed.push_back(translated(cube, Vec3(20 + i, 20, 0), true));
  const RigidScene scene(std::move(moving), std::move(fixed));
  MotionOptions options;
  options.tolerance = 1e-4;
  options.earliest = true;
  QueryContext context;
  const MotionResult result =
      scene.certifyEdge(at(Vec3(0, 0, 0)), at(Vec3(5, 0, 0)), options, context);
  EXPECT_EQ(result.verdict, MotionVerdict::contact);
  EXPECT_EQ(result.time, 0);
  EXPECT_EQ(result.certifiedUntil, 0);
}

/// Interference and clearance of states must be the same as without a broad phase, also if the pose
/// of the world frame is not the identity.
TEST(BroadPhase, StatesHaveTheSameAnswers) {
  std::mt19937_64 random(testSeed(244));
  int contacts = 0, apart = 0;
  for (const bool solids : {false, true}) {
    const RigidScene crowded = crowd(random, 150, solids);
    const Scene& scene = crowded.scene();
    for (int n = 0; n < 120; ++n) {
      const Transform X_WB = anyPose(random, 1.5);
      const Transform X_WW = n % 4 == 0 ? anyPose(random, 0.5) : Transform();
      const Transform X_WF[] = {X_WW, X_WB};
      QueryContext context;
      bool touches = false;
      double least = std::numeric_limits<double>::infinity();
      for (const Scene::Pair& pair : scene.pairs()) {
        const Posed a(scene.bodies()[pair.a].body, X_WW), b(scene.bodies()[pair.b].body, X_WB);
        touches = touches || interference(a, b, context).has_value();
        least = std::min(least, distance(a, b, {}, context).distance);
      }
      EXPECT_EQ(scene.interference(X_WF, context).has_value(), touches) << n;
      EXPECT_NEAR(scene.clearance(X_WF, context), least, 1e-12) << n;
      ++(touches ? contacts : apart);
    }
  }
  EXPECT_GT(contacts, 20);
  EXPECT_GT(apart, 20);
}

/// Among thousands of obstacles, the tree finds only those near the motion.
TEST(BroadPhase, TakesLogarithmicTime) {
  std::vector<Body> moving, fixed;
  const TriangleMesh cube = box(Vec3(-0.1, -0.1, -0.1), Vec3(0.1, 0.1, 0.1));
  moving.push_back(bodyOf(cube));
  for (int i = 0; i < 3000; ++i)
    fixed.push_back(translated(cube, Vec3(i % 50, 10 + (i / 50) % 60, 0), false));
  const RigidScene scene(std::move(moving), std::move(fixed));
  RigidEdge edge(RigidMotion::spatial(at(Vec3(0, 0, 0)), at(Vec3(1, 1, 1)), {}));
  QueryContext context;
  IntervalMotions motions(edge, scene.scene().bodies().size(), context);
  motions.select(0.5, 0.5);
  const BroadPhase broadPhase(scene.scene().motionPairs());
  std::vector<std::uint32_t> found;
  broadPhase.find(motions, 1, found);
  EXPECT_TRUE(found.empty());
  broadPhase.find(motions, 10, found);
  EXPECT_GT(found.size(), 2u);
  EXPECT_LT(found.size(), 200u);
  EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
}

/// Let d be the defect of a map, the largest entry of MᵀM − 1. Such a map can move a point by more
/// than d times the point's distance from the origin. The nearest point of the robot is between the
/// sphere of radius 1 + d and the surface of the image of a ball of radius 1.
TEST(BroadPhase, BodiesAtRestUnderMapsThatAreNotRigid) {
  for (const double d : {0x1p-11, 0.1, 0.9}) {
    const Mat3 square = Mat3::Identity() + Mat3::Constant(d);
    const Eigen::Quaterniond q =
        Eigen::Quaterniond::FromTwoVectors(Vec3(1, 1, 1).normalized(), Vec3::UnitX());
    const Mat3 m =
        q.toRotationMatrix() * Eigen::SelfAdjointEigenSolver<Mat3>(square).operatorSqrt();
    const Transform X_WRobot{Mat3::Identity(),
                             Vec3(0.5 + 0.5 * (std::sqrt(1 + 3 * d) + 1 + d), 0, 0)};
    const ConvexPart ball = placed(Sphere{1}, {});
    for (const std::size_t many : {1, 40}) {  // with 40, the boxes are in a tree
      std::vector<Scene::Placed> bodies;
      std::vector<Scene::Pair> pairs;
      std::vector<Transform> X_WF(many + 2);
      for (std::size_t i = 0; i < many; ++i) {
        const Transform X{m, Vec3(0, 20.0 * static_cast<double>(i), 0)};
        bodies.push_back({Body("obstacle", ball), i + 1, X});
        pairs.push_back({i, many});
      }
      bodies.push_back({Body("robot", placed(Sphere{0.5}, {})), many + 1});
      X_WF.back() = X_WRobot;
      const Scene scene(std::move(bodies), std::move(pairs));
      QueryContext context;
      EXPECT_EQ(scene.clearance(X_WF, context), 0) << d << ", " << many;
      EXPECT_TRUE(scene.interference(X_WF, context)) << d << ", " << many;
    }
  }
}

}  // namespace
}  // namespace corridor::test
