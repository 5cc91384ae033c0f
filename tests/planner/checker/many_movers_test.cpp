// Scenes of many moving bodies: the sweep of the broad phase must not change any answer.
#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "collision/motion/broad_phase.h"
#include "collision/motion/certify_motion.h"
#include "collision/world/body_queries.h"
#include "collision/world/scene.h"
#include "planner/checker/checker.h"
#include "planner/model/model_builder.h"
#include "planner/problem/problem.h"
#include "planner/robot/edge_motion.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

/// Returns `count` boxes and balls that float in a room, with one obstacle.
Problem crowd(std::size_t count) {
  ModelBuilder builder;
  const Corners room{Vec3(-3, -2, -1), Vec3(3, 2, 1)};
  for (std::size_t i = 0; i < count; ++i) {
    const std::string name = "b" + std::to_string(i);
    const Primitive shape = i % 3 ? Primitive(Box{Vec3(0.1, 0.15, 0.2)}) : Primitive(Sphere{0.1});
    builder.addRigidBody(name, JointType::floating, {shapeOf(name, shape)}, room);
  }
  builder.addObstacle("post", Box{Vec3(0.2, 0.2, 2)});
  Problem problem;
  problem.model = builder.build();
  problem.task.tube = tubeOf(problem.model.space);
  return problem;
}

Vec3 inCube(std::mt19937_64& random) {
  std::uniform_real_distribution<double> real(-1, 1);
  const double x = real(random), y = real(random);
  return {x, y, real(random)};
}

/// Returns a random configuration: for each body x, y, z and a unit quaternion.
Configuration randomState(const Model& model, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  Configuration q(model.space.size());
  for (Eigen::Index i = 0; i < q.size(); i += 7) {
    q.segment<3>(i) = inCube(random).cwiseProduct(Vec3(3, 2, 1));
    for (Eigen::Index k = 3; k < 7; ++k) q[i + k] = normal(random);
    q.segment<4>(i + 3).normalize();
  }
  return q;
}

TEST(ManyMovers, TheSweepChangesNoAnswer) {
  std::mt19937_64 random(test::testSeed(251));
  std::map<MotionVerdict, int> verdicts;
  std::size_t found = 0, all = 0;
  for (const std::size_t count : {4u, 26u, 40u}) {  // 6, 325 and 780 pairs of moving bodies
    const Problem problem = crowd(count);
    const Checker checker(problem);
    const Scene& scene = checker.scene();
    EdgeMotion motion(problem.model.tree, problem.model.space, scene.framePairs(), checker.tube());
    const BroadPhase broadPhase(scene.motionPairs());
    QueryContext context;
    for (int n = 0; n < 60; ++n) {
      const Configuration from = randomState(problem.model, random);
      Configuration to = from;
      const double length = n % 3 == 0 ? 0.02 : 0.2;
      for (Eigen::Index i = 0; i < to.size(); i += 7) to.segment<3>(i) += length * inCube(random);
      MotionOptions options = checker.options();
      options.margin = n % 4 == 0 ? 0.05 : 0;
      motion.set(from, to);
      const MotionResult with = scene.certify(motion, options, context);
      const MotionResult without = certifyMotion(motion, scene.motionPairs(), options, context);
      EXPECT_EQ(with.verdict, without.verdict) << count << " bodies, edge " << n;
      ++verdicts[with.verdict];
      IntervalMotions motions(motion, broadPhase.bodies(), context);
      motions.select(0.5, 0.5);
      std::vector<std::uint32_t> near;
      broadPhase.find(motions, options.margin, near);
      EXPECT_TRUE(std::ranges::is_sorted(near));
      // Pairs that are left out are free; the others include all that are not.
      const std::vector<MotionResult> each = scene.certifyEachPair(motion, options, context);
      std::size_t next = 0;
      for (std::size_t k = 0; k < scene.pairs().size(); ++k) {
        const bool isNear = next < near.size() && near[next] == k;
        next += isNear;
        if (isNear) continue;
        EXPECT_EQ(
            certifyMotion(motion, scene.motionPairs().subspan(k, 1), options, context).verdict,
            MotionVerdict::free)
            << count << " bodies, edge " << n << ", pair " << k;
        EXPECT_EQ(each[k].verdict, MotionVerdict::free);
      }
      EXPECT_EQ(next, near.size());
      if (count == 40) found += near.size(), all += scene.pairs().size();
    }
  }
  EXPECT_LT(found, all / 4) << "the sweep leaves out most pairs";
  EXPECT_GT(verdicts[MotionVerdict::free], 20);
  EXPECT_GT(verdicts[MotionVerdict::contact], 20);
}

TEST(ManyMovers, StatesHaveTheSameContactsAndClearances) {
  std::mt19937_64 random(test::testSeed(252));
  const Problem problem = crowd(40);
  const Checker checker(problem);
  const Scene& scene = checker.scene();
  int contacts = 0;
  for (int n = 0; n < 60; ++n) {
    const Configuration q = randomState(problem.model, random);
    const std::vector<Transform> maps = framePoses(problem.model.tree, q);
    const auto posed = [&](std::size_t body) {
      const Scene::Placed& placed = scene.bodies()[body];
      return Posed(placed.body, placed.restX_WF ? *placed.restX_WF : maps[placed.frame]);
    };
    QueryContext context;
    double least = HUGE_VAL;
    std::size_t near = 0;
    for (const Scene::Pair& pair : scene.pairs()) {
      const double one = distance(posed(pair.a), posed(pair.b), {}, context).distance;
      least = std::min(least, one);
      near += one <= 0.1;
    }
    EXPECT_EQ(scene.interference(maps, context).has_value(), least == 0) << "state " << n;
    EXPECT_EQ(scene.clearance(maps, context), least) << "state " << n;
    const PairMargins within(std::vector<double>(scene.pairs().size(), 0.1));
    EXPECT_EQ(scene.pairsWithin(maps, within, {}, context, {}).size(), near) << "state " << n;
    contacts += least == 0;
  }
  EXPECT_GT(contacts, 5);
  EXPECT_LT(contacts, 55);
}

}  // namespace
}  // namespace corridor
