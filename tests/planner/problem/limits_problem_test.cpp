#include "tests/planner/problem/arm_fixture.h"

namespace corridor::test {
namespace {

class LimitsOfProblem : public ArmTest {};

TEST_F(LimitsOfProblem, UrdfGivesVelocities) {
  const Problem problem = read(armHead + armStates);
  const JointLimits& limits = problem.task.limits;
  ASSERT_EQ(limits.velocity.size(), 2);
  EXPECT_EQ(limits.velocity[0], std::numeric_limits<double>::infinity());  // pan has no <limit>
  EXPECT_EQ(limits.velocity[1], 1);
  EXPECT_EQ(limits.acceleration[1], 1);
}

TEST_F(LimitsOfProblem, LimitsAreRead) {
  write("joint_limits.yaml", "joint_limits: {pan: {has_velocity_limits: true, max_velocity: 2}}\n");
  const Problem problem = read(armHead + armStates +
                               "limits: {file: joint_limits.yaml, velocity_scale: 0.5, joints: "
                               "{lift: {acceleration: 3}}}\n");
  EXPECT_EQ(problem.task.limits.velocity[0], 1);
  EXPECT_EQ(problem.task.limits.velocity[1], 0.5);
  EXPECT_EQ(problem.task.limits.acceleration[1], 3);
  EXPECT_EQ(problem.source.files.back().filename(), "joint_limits.yaml");
}

}  // namespace
}  // namespace corridor::test
