// Tests of the messages about a start or a goal that is not free.
#include "planner/solve/why_not_free.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planner/checker/problem_goal.h"
#include "tests/planner/checker/hall.h"
#include "tests/support/floating_point.h"

namespace corridor {
namespace {

TEST(WhyNotFree, NamesFloatingPointSettings) {
  const Problem problem = test::hallProblem(test::Rigid::SE3);
  const Checker checker(problem);
  for (const auto& setting : test::floatingPointSettings()) {
    std::optional<std::string> why;
    {
      const test::WithFloatingPoint set(setting);
      why = whyNotFree(startOf(problem), checker);
    }
    if (setting.standard())
      EXPECT_EQ(why, std::nullopt) << setting.name;
    else
      EXPECT_THAT(why.value_or(""), testing::StartsWith("nothing can be proved with these "
                                                        "floating-point settings: "))
          << setting.name;
  }
}

}  // namespace
}  // namespace corridor
