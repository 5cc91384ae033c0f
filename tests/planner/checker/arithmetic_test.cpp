// In a floating-point mode in which no bound holds, the checker must refuse every query.
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>

#include "planner/checker/checker.h"
#include "planner/checker/problem_goal.h"
#include "planner/robot/edge_motion.h"
#include "tests/support/floating_point.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

TEST(CheckerArithmetic, OtherFloatingPointModesAreRefusedInEveryThread) {
  const Problem problem =
      readProblem(std::filesystem::path(CORRIDOR_SOURCE_DIR) / "problems/arm_at_shelf");
  const Checker checker(problem);
  const Configuration start = startOf(problem);
  ASSERT_EQ(checker.certifyState(start).verdict, MotionVerdict::free);
  for (const auto& setting : test::floatingPointSettings()) {
    MotionResult state, edge;
    bool throws = false;
    const auto query = [&] {
      const test::WithFloatingPoint set(setting);
      state = checker.certifyState(start);
      edge = checker.certifyEdge(start, start, {.earliest = true});
      try {
        checker.interference(start);
      } catch (const std::runtime_error&) {
        throws = true;
      }
    };
    query();  // in a thread that already has a workspace; below, in new threads
    for (int n = 0; n < 2; ++n, std::thread(query).join()) {
      EXPECT_EQ(throws, !setting.standard()) << setting.name;
      for (const MotionResult& result : {state, edge}) {
        EXPECT_EQ(result.verdict,
                  setting.standard() ? MotionVerdict::free : MotionVerdict::undecided)
            << setting.name;
        if (!setting.standard()) {
          EXPECT_EQ(result.reason, UndecidedReason::floatingPoint) << setting.name;
        }
      }
    }
  }
}

/// If a motion was set in a floating-point mode in which no bound holds, queries refuse it even
/// after the mode was restored.
TEST(CheckerArithmetic, MotionsSetInOtherModesAreRefused) {
  const Problem problem =
      readProblem(std::filesystem::path(CORRIDOR_SOURCE_DIR) / "problems/arm_at_shelf");
  const Scene scene = makeScene(problem.model, requiredBy(problem.task));
  EdgeMotion motion(problem.model.tree, problem.model.space, scene.framePairs(), problem.task.tube);
  const Configuration start = startOf(problem);
  for (const auto& setting : test::floatingPointSettings()) {
    {
      const test::WithFloatingPoint set(setting);
      motion.set(start, start);
    }
    EXPECT_EQ(motion.ambiguous(), !setting.standard()) << setting.name;
  }
}

}  // namespace
}  // namespace corridor
