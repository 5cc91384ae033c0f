#include <iostream>
#include <stdexcept>

#include <ompl/geometric/SimpleSetup.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>

#include "planner/checker/motion_validators.h"
#include "planner/checker/problem_state_space.h"
#include "planner/checker/state_validity_checkers.h"
#include "planner/model/model_builder.h"

int main(int count, char** arguments) try {
  if (count != 2) throw std::invalid_argument("usage: rigid MESH");
  using namespace corridor;
  const TriangleMesh mesh = readMeshFile(arguments[1]).mesh;  // metres
  const Model model = ModelBuilder()
                          .addRigidBody("body", JointType::floating, {shapeOf("body", mesh)},
                                        {{-3, -3, -3}, {3, 3, 3}})  // bounds of its position
                          .addObstacle("wall", Box{{0.1, 4, 4}})
                          .build();
  const Checker checker(model);
  const auto space = std::make_shared<ProblemStateSpace>(model.space);
  ompl::geometric::SimpleSetup setup(space);
  const auto& si = setup.getSpaceInformation();
  setup.setStateValidityChecker(std::make_shared<CertifiedStateValidityChecker>(si, checker));
  si->setMotionValidator(std::make_shared<CertifiedMotionValidator>(si, checker));
  setup.setPlanner(std::make_shared<ompl::geometric::RRTConnect>(si));
  ompl::base::ScopedState<> start(space), goal(space);
  start = std::vector<double>{-2, 0, 0, 0, 0, 0, 1};  // x, y, z, quaternion (x, y, z, w)
  goal = std::vector<double>{2, 0, 0, 0, 0, 0, 1};
  setup.setStartAndGoalStates(start, goal);
  if (setup.solve(20) != ompl::base::PlannerStatus::EXACT_SOLUTION) return 1;
  const bool certified = setup.getSolutionPath().check();
  std::cout << (certified ? "certified\n" : "not certified\n");
  return certified ? 0 : 1;
} catch (const std::exception& error) {
  std::cerr << error.what() << "\n";
  return 2;
}
