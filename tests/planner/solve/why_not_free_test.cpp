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

/// A ball of radius 0.5 m between others.
TEST(WhyNotFree, NamesTheGapAndTheOtherPairs) {
  using testing::AllOf, testing::HasSubstr, testing::StartsWith;
  Problem problem = test::rigidProblem(test::Rigid::SE2);
  const auto ball = [](double radius, const Vec3& at) {
    return std::vector<PlacedShape>{test::partShape("ball", Sphere{radius}, at)};
  };
  const auto why = [&] {
    return whyNotFree(test::poseOf(test::Rigid::SE2, 0, 0), Checker(problem)).value_or("free");
  };
  problem.model.bodies = {{"ball", 2, 0, ball(0.5, Vec3::Zero())},
                          {"left", 0, {}, ball(0.25, {-0.95 + 1e-9, 0, 0})}};
  EXPECT_EQ(why(), "free");
  problem.task.margin = 0.2;
  const std::string left =
      "too close: \"ball\" and \"left\" are 0.199999999 m apart; more than the margin of 0.2 m is "
      "needed; ";
  EXPECT_THAT(why(), StartsWith(left + "the nearest free position"));
  // A tube does not hide that the margin is the reason.
  problem.task.tube.setConstant(0.01);
  EXPECT_THAT(why(), StartsWith(left + "the nearest free position"));
  problem.task.margin = 0.199;
  EXPECT_THAT(
      why(), AllOf(StartsWith("the gap between \"ball\" and \"left\" is 0.001 m beyond the margin, "
                              "and the tube needs "),
                   HasSubstr("; move the two bodies apart, or reduce the margin or the tube")));
  problem.task.margin = 0.2;
  problem.task.tube = test::roundingTube(problem.model.space);
  problem.model.bodies.push_back({"right", 0, {}, ball(0.25, {0.9, 0, 0})});
  const std::string right =
      "too close: \"ball\" and \"right\" are 0.15 m apart; more than the margin of 0.2 m is "
      "needed; ";
  EXPECT_THAT(
      why(), testing::AnyOf(
                 StartsWith(left + "not proved free either: \"ball\" and \"right\"; the nearest"),
                 StartsWith(right + "not proved free either: \"ball\" and \"left\"; the nearest")));
  // A pair that touches is named first, whatever pair the checker finds.
  for (const bool first : {true, false}) {
    Problem touching = problem;
    std::vector<ModelBody>& bodies = touching.model.bodies;
    bodies.insert(first ? bodies.begin() + 1 : bodies.end(),
                  {"above", 0, {}, ball(0.3, {0, 0.75, 0})});
    const std::string text =
        whyNotFree(test::poseOf(test::Rigid::SE2, 0, 0), Checker(touching)).value_or("free");
    EXPECT_THAT(text, StartsWith("in contact: \"ball\" and \"above\" touch; not proved free "
                                 "either: \"ball\" and \"left\", \"ball\" and \"right\"; "));
  }
}

}  // namespace
}  // namespace corridor
