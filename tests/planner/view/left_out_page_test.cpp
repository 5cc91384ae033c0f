// Tests of what a page says about pairs that touch in every state, or are allowed to.
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planner/checker/problem_goal.h"
#include "planner/view/view_page.h"
#include "tests/planner/view/page_reader.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

/// A foot at z = 0, an arm that turns, and a flag on a held joint 2 m up.
class LeftOutPage : public testing::Test {
 protected:
  LeftOutPage() : folder_(test::newFolder()) {
    const auto link = [](const std::string& name) {
      return "<link name='" + name +
             "'><collision><geometry><sphere radius='0.1'/></geometry></collision></link>";
    };
    const std::string limits =
        "<axis xyz='0 0 1'/><limit lower='-3' upper='3' effort='1' velocity='1'/></joint>";
    std::ofstream(folder_ / "arm.urdf")
        << "<robot name='arm'>" << link("foot") << link("arm") << link("flag")
        << "<joint name='turn' type='revolute'><parent link='foot'/><child link='arm'/>"
           "<origin xyz='0 0 1'/>"
        << limits
        << "<joint name='hoist' type='prismatic'><parent link='foot'/><child link='flag'/>"
           "<origin xyz='1 0 2'/>"
        << limits << "</robot>";
    std::ofstream(folder_ / "robot.yaml")
        << "format: corridor-robot-1\nurdf: arm.urdf\njoints: [turn]\n";
  }
  ~LeftOutPage() override { std::filesystem::remove_all(folder_); }

  /// Returns the data of the page of a straight path, with a ball as an obstacle.
  nlohmann::json pageOf(const std::string& ball) {
    std::ofstream(folder_ / "p.yaml")
        << "format: corridor-problem-1\nrobot: robot.yaml\nworld: {ball: {sphere: 0.1, at: " << ball
        << "}}\nstart: {turn: 0}\ngoal: {turn: 1}\n";
    const Problem problem = readProblem(folder_ / "p.yaml");
    ViewedPath path;
    path.solution.path = {startOf(problem), goalsOf(problem)[0]};
    path.report = verifySolution(problem, path.solution);
    const test::PageReader page(viewPage(problem, path));
    atRest_ = page.array<std::size_t>(page.json["pairs"]["at_rest"]);
    return page.json;
  }

  std::filesystem::path folder_;
  std::vector<std::size_t> atRest_;
};

TEST_F(LeftOutPage, SaysWhatTheProofLeavesOut) {
  const nlohmann::json page = pageOf("[0, 0.15, 0]");  // touches the foot, body 0; it is body 3
  EXPECT_EQ(page["verdict"]["verdict"], "proved");
  EXPECT_EQ(page["verdict"]["except"],
            ", except 1 pair that touches at rest or is allowed to: foot ~ ball");
  EXPECT_EQ(page["verdict"]["left_out"], (nlohmann::json{{0, 3, "touch at rest"}}));
  EXPECT_THAT(page["notes"][0].get<std::string>(),
              testing::StartsWith("in every state, these bodies touch: foot ~ ball; "));
  EXPECT_THAT(atRest_, testing::ElementsAre(2, 3)) << "the flag and the ball";
}

TEST_F(LeftOutPage, SaysNothingIfNothingIsLeftOut) {
  const nlohmann::json page = pageOf("[0, 1, 0]");
  EXPECT_EQ(page["verdict"]["verdict"], "proved");
  EXPECT_EQ(page["verdict"]["except"], "");
  EXPECT_TRUE(page["verdict"]["left_out"].empty());
}

TEST_F(LeftOutPage, IsNotGreenIfAHeldLinkTouches) {
  const nlohmann::json page = pageOf("[1, 0.15, 2]");
  EXPECT_EQ(page["verdict"]["verdict"], "refuted");
  EXPECT_FALSE(page["verdict"].contains("except"));
  ASSERT_EQ(page["verdict"]["findings"].size(), 1u);
  EXPECT_EQ(page["verdict"]["findings"][0]["in_every_state"], true);
  EXPECT_EQ(page["verdict"]["findings"][0]["a"], 2);
  EXPECT_EQ(page["verdict"]["findings"][0]["b"], 3);
}

}  // namespace
}  // namespace corridor
