#pragma once

#include "planner/problem/problem.h"
#include "tests/planner/checker/boxes.h"

namespace corridor::test {

/// The hall of boxes.h as a problem: a bar from one side of the wall to the other, through the gap
/// above y = 2.
inline Problem hallProblem(RigidSpace space) {
  Problem problem;
  problem.file = "hall.yaml";
  problem.name = "hall";
  problem.digest = "0123456789abcdef";
  problem.space = space;
  problem.robot.resize(1);
  problem.robot[0].name = "bar";
  problem.robot[0].source.mesh = boxMesh({1, 0.2, 0.2});
  problem.world.resize(1);
  problem.world[0].name = "wall";
  problem.world[0].source.mesh = boxMesh({0.001, 7, 10}, {0, -1.5, 0});
  problem.start.p = {-3, -2, 0};
  problem.goal.p = {3, -2, 0};
  problem.goalYaw = 3;
  problem.goal.q = Eigen::AngleAxisd(3, Vec3::UnitZ());
  problem.lower = Vec3::Constant(-5);
  problem.upper = Vec3::Constant(5);
  problem.planner.time = 20;
  problem.lines = {{"start", 4},
                   {"goal", 5},
                   {"planner", 7},
                   {"planner.name", 8},
                   {"planner.params.range", 9},
                   {"sampler", 11},
                   {"objective", 12}};
  return problem;
}

}  // namespace corridor::test
