// In no random configuration may a body leave its computed box of reach.
#include "planner/model/reach.h"

#include <gtest/gtest.h>
#include <ompl/util/RandomNumbers.h>

#include "tests/planner/checker/hall.h"

namespace corridor {
namespace {

using test::Rigid;

/// Tests all vertices of all bodies in many configurations, including the extremes.
void expectInside(const Problem& problem) {
  ompl::RNG::setSeed(5);
  const std::vector<ReachBox> boxes = reachOf(problem.model);
  const auto space = std::make_shared<ProblemStateSpace>(problem.model.space);
  ompl::base::ScopedState<> state(space);
  for (int i = 0; i < 500; ++i) {
    state.random();
    const std::vector<Transform> poses = framePoses(problem.model.tree, space->read(state.get()));
    for (std::size_t b = 0; b < boxes.size(); ++b)
      for (const PlacedShape& shape : problem.model.bodies[b].shapes)
        for (const Vec3& p : shape.mesh ? shape.mesh->mesh.vertices : shape.parts.at(0).points) {
          const Vec3 x = poses[problem.model.bodies[b].frame] * p;
          ASSERT_TRUE((x.array() >= boxes[b].lower.array() - 1e-9).all() &&
                      (x.array() <= boxes[b].upper.array() + 1e-9).all())
              << problem.model.bodies[b].name << " at " << x.transpose();
        }
  }
}

TEST(Reach, BodiesStayInTheirBoxes) {
  for (const Problem& problem :
       {test::hallProblem(Rigid::SE2), test::hallProblem(Rigid::SE3), test::armProblem()})
    expectInside(problem);
}

TEST(Reach, APlanarBodyNeverLeavesItsHeight) {
  Problem problem = test::hallProblem(Rigid::SE2);
  problem.model.bodies.push_back(
      {"lamp", 0, {}, {test::meshShape("lamp", test::boxMesh({1, 1, 1}, {0, 0, 2}))}});
  const std::vector<ReachBox> boxes = reachOf(problem.model);
  EXPECT_FALSE(outOfReach(problem.task, boxes[0], boxes[1]));
  EXPECT_TRUE(outOfReach(problem.task, boxes[0], boxes[2]));
  problem.task.margin = 1.5;
  EXPECT_FALSE(outOfReach(problem.task, boxes[0], boxes[2]));
}

TEST(Reach, AnArmReachesTheSumOfItsLinks) {
  Problem problem = test::armProblem();
  problem.model.bodies.push_back({"far", 0, {}, {test::partShape("far", Sphere{0.1}, {6, 0, 0})}});
  problem.model.bodies.push_back(
      {"near", 0, {}, {test::partShape("near", Sphere{0.1}, {2.5, 0, 0})}});
  const std::vector<ReachBox> boxes = reachOf(problem.model);
  EXPECT_TRUE(outOfReach(problem.task, boxes[2], boxes[5]));
  EXPECT_FALSE(outOfReach(problem.task, boxes[2], boxes[6]));
}

}  // namespace
}  // namespace corridor
