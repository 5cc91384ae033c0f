#include <iostream>
#include <stdexcept>

#include <ompl/geometric/SimpleSetup.h>

#include "planner/checker/motion_validators.h"
#include "planner/checker/problem_state_space.h"
#include "planner/checker/state_validity_checkers.h"
#include "planner/model/model_builder.h"

int main(int count, char** arguments) try {
  if (count != 2) throw std::invalid_argument("usage: plan ROBOT.urdf");
  const corridor::Model model = corridor::ModelBuilder()
                                    .addRobot(arguments[1])  // a URDF file
                                    .addObstacle("post", corridor::Cylinder{0.05, 2}, {{0.5, 0, 1}})
                                    .build();
  const corridor::Checker checker(model, {.margin = 0.002});  // metres between all bodies
  const auto space = std::make_shared<corridor::ProblemStateSpace>(model.space);
  ompl::geometric::SimpleSetup setup(space);
  const auto& si = setup.getSpaceInformation();
  setup.setStateValidityChecker(
      std::make_shared<corridor::CertifiedStateValidityChecker>(si, checker));
  si->setMotionValidator(std::make_shared<corridor::CertifiedMotionValidator>(si, checker));
  ompl::base::ScopedState<> start(space), goal(space);
  start = std::vector<double>{-1, 1, 1, 0, 0, 0};  // radians, in the order of the URDF's joints
  goal = std::vector<double>{1, 1, 1, 0, 0, 0};
  setup.setStartAndGoalStates(start, goal);
  // Without this test a path that ends short of the goal would count as solved.
  if (setup.solve(20) != ompl::base::PlannerStatus::EXACT_SOLUTION) return 1;
  setup.simplifySolution();
  const bool certified = setup.getSolutionPath().check();  // proves every edge once more
  std::cout << (certified ? "certified\n" : "not certified\n");
  return certified ? 0 : 1;
} catch (const std::exception& error) {
  std::cerr << error.what() << "\n";
  return 2;
}
