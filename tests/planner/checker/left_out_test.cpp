#include "planner/checker/left_out.h"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planner/problem/problem.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

/// Two carts on rails, each with a base, a box that moves along x, and a lid that is fixed to it.
class LeftOutPairs : public testing::Test {
 protected:
  LeftOutPairs() : folder_(test::newFolder()) {
    const auto link = [](const std::string& name) {
      return "<link name='" + name +
             "'><collision><geometry><sphere radius='0.1'/></geometry></collision></link>";
    };
    std::ofstream(folder_ / "cart.urdf")
        << "<robot name='cart'>" << link("base") << link("box") << link("lid")
        << "<joint name='x' type='prismatic'><parent link='base'/><child link='box'/>"
           "<origin xyz='0 0 1'/><limit lower='0' upper='1' effort='1' velocity='1'/></joint>"
        << "<joint name='hinge' type='fixed'><parent link='box'/><child link='lid'/>"
           "<origin xyz='0 0 0.1'/></joint></robot>";
    std::ofstream(folder_ / "cart.srdf")
        << "<robot name='cart'><disable_collisions link1='base' link2='lid' reason='Never'/>"
           "</robot>";
    std::ofstream(folder_ / "cart.yaml")
        << "format: corridor-robot-1\nurdf: cart.urdf\nsrdf: cart.srdf\n";
  }
  ~LeftOutPairs() override { std::filesystem::remove_all(folder_); }

  Problem problemOf(const std::string& keys) {
    std::ofstream(folder_ / "p.yaml")
        << "format: corridor-problem-1\n"
           "robots: {a: {file: cart.yaml}, b: {file: cart.yaml, base: {at: [0, 1, 0]}}}\n"
           "start: {a: {x: 0}, b: {x: 0}}\ngoal: {a: {x: 1}, b: {x: 1}}\n"
        << keys;
    return readProblem(folder_ / "p.yaml");
  }

  std::filesystem::path folder_;
};

TEST_F(LeftOutPairs, OfOneRobotAreItsConstruction) {
  const Problem problem = problemOf("");
  const LeftOut leftOut = leftOutOf(problem);
  EXPECT_THAT(leftOut.except, IsEmpty());
  EXPECT_EQ(exceptText(problem.model, leftOut), "");
  EXPECT_THAT(leftOut.reasons, ElementsAre(Pair("SRDF: Never", 2), Pair("adjacent", 4),
                                           Pair("never move relative to each other", 1)))
      << "the bases of the two carts";
  EXPECT_EQ(leftOut.tested, 8u);
  EXPECT_EQ(leftOut.testedAtRest, 0u);
  EXPECT_EQ(notTestedText(leftOut),
            "7 pairs: 4 adjacent, 2 SRDF, 1 never move relative to each other");
}

TEST_F(LeftOutPairs, TouchAtRestOrAreAllowed) {
  const Problem problem = problemOf(
      "world: {floor: {box: [9, 9, 1], at: [0, 0, -0.6]}, near: {sphere: 0.1, at: [0, "
      "0.5, 0]}, wall: {box: [1, 9, 9], at: [5, 0, 0]}}\n"
      "allow: [[a/box, b/box], [a/lid, wall], [a/box, a/base]]\nmargin: 0.35\n");
  const LeftOut leftOut = leftOutOf(problem);
  std::vector<std::string> texts;
  for (const LeftOutPair& pair : leftOut.except)
    texts.push_back(problem.model.bodies[pair.a].name + " ~ " + problem.model.bodies[pair.b].name +
                    ": " + nameOf(pair.reason));
  EXPECT_THAT(texts, ElementsAre("a/base ~ a/box: allow", "a/base ~ floor: touch at rest",
                                 "a/base ~ near: within the margin at rest", "a/box ~ b/box: allow",
                                 "a/lid ~ wall: allow", "b/base ~ floor: touch at rest",
                                 "b/base ~ near: within the margin at rest"));
  EXPECT_EQ(exceptText(problem.model, leftOut),
            ", except 7 pairs that touch or are within the margin at rest, or are allowed to: "
            "a/base ~ a/box, a/base ~ floor, a/base ~ near, a/box ~ b/box and 3 more");
  EXPECT_EQ(leftOut.reasons.at("allow"), 3u);
  EXPECT_EQ(leftOutOf(Checker(problem)).except.size(), 7u);
}

TEST_F(LeftOutPairs, TextsHaveTheRightNumber) {
  const Problem problem = problemOf("allow: [[a/box, b/box]]\n");
  LeftOut leftOut = leftOutOf(problem);
  EXPECT_EQ(exceptText(problem.model, leftOut),
            ", except 1 pair that touches at rest or is allowed to: a/box ~ b/box");
  leftOut.except.push_back({0, 3, LeftOutReason::touchesAtRest});
  EXPECT_EQ(
      exceptText(problem.model, leftOut),
      ", except 2 pairs that touch at rest or are allowed to: a/box ~ b/box, a/base ~ b/base");
  leftOut.except = {{0, 3, LeftOutReason::isCloseAtRest}};
  EXPECT_EQ(exceptText(problem.model, leftOut),
            ", except 1 pair that touches or is within the margin at rest, or is allowed to: "
            "a/base ~ b/base");
}

TEST(NotTestedText, GroupsReasons) {
  LeftOut leftOut;
  EXPECT_EQ(notTestedText(leftOut), "no pair");
  leftOut.reasons = {{"allow", 1}};
  EXPECT_EQ(notTestedText(leftOut), "1 pair: 1 allow");
  leftOut.reasons = {{"adjacent", 6},
                     {"SRDF", 1},
                     {"SRDF: Never", 3},
                     {"SRDF: Adjacent", 1},
                     {"robot.yaml: never_in_contact", 2},
                     {"robot.yaml: allow", 1},
                     {"allow", 1}};
  EXPECT_EQ(notTestedText(leftOut),
            "15 pairs: 6 adjacent, 5 SRDF, 2 allow, 2 never_in_contact (proved)");
  EXPECT_THAT(reasonGroups(leftOut), ElementsAre(Pair("SRDF", 5), Pair("adjacent", 6),
                                                 Pair("allow", 2), Pair("never_in_contact", 2)));
}

}  // namespace
}  // namespace corridor
