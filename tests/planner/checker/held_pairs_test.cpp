#include "planner/checker/held_pairs.h"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planner/checker/checker.h"
#include "planner/checker/left_out.h"
#include "planner/checker/problem_goal.h"
#include "planner/problem/problem.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// A base at the origin, an arm 1 m up that turns, and three balls that are held: a lift 1 m to the
/// side of the base, a hand on the arm 0.5 m out, and a lamp that is fixed to the hand.
class HeldPairs : public testing::Test {
 protected:
  HeldPairs() : folder_(test::newFolder()) { writeUrdf(); }
  ~HeldPairs() override { std::filesystem::remove_all(folder_); }

  static std::string ball(const std::string& name) {
    return "<link name='" + name +
           "'><collision><geometry><sphere radius='0.1'/></geometry></collision></link>";
  }

  static std::string joint(const std::string& name, const std::string& type,
                           const std::string& parent, const std::string& child,
                           const std::string& at,
                           const std::string& more =
                               "<limit lower='-1' upper='1' effort='1' "
                               "velocity='1'/>") {
    return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
           "'/><child link='" + child + "'/><origin xyz='" + at + "'/><axis xyz='0 0 1'/>" + more +
           "</joint>";
  }

  void writeUrdf(const std::string& lift = "<limit lower='-1' upper='1' effort='1' velocity='1'/>",
                 const std::string& liftType = "prismatic") {
    std::ofstream(folder_ / "arm.urdf")
        << "<robot name='arm'>" << ball("base") << ball("arm") << ball("lift") << ball("hand")
        << ball("lamp") << joint("turn", "revolute", "base", "arm", "0 0 1")
        << joint("raise", liftType, "base", "lift", "0 1 0", lift)
        << joint("slide", "prismatic", "arm", "hand", "0.5 0 0")
        << joint("screws", "fixed", "hand", "lamp", "0.15 0 0") << "</robot>";
  }

  Problem problemOf(const std::string& keys, const std::string& robot = "") {
    std::ofstream(folder_ / "robot.yaml")
        << "format: corridor-robot-1\nurdf: arm.urdf\njoints: [turn]\n"
        << robot;
    std::ofstream(folder_ / "problem.yaml") << "format: corridor-problem-1\nrobot: robot.yaml\n"
                                            << "start: {turn: 0}\ngoal: {turn: 0.5}\n"
                                            << keys;
    return readProblem(folder_ / "problem.yaml");
  }

  /// Returns the pairs that are not free at rest, "a ~ b".
  static std::vector<std::string> pairsOf(const Problem& problem) {
    const Checker checker(problem);
    std::vector<std::string> names;
    for (const HeldPair& pair : checker.notFreeAtRest())
      names.push_back(problem.model.bodies[pair.a].name + " ~ " +
                      problem.model.bodies[pair.b].name);
    const MotionVerdict verdict = checker.certifyState(startOf(problem)).verdict;
    EXPECT_EQ(verdict == MotionVerdict::free, names.empty());
    return names;
  }

  /// A wall whose face is `gap` metres from the ball of the lift.
  static std::string wallAt(double gap) {
    return "world: {wall: {box: [0.2, 0.2, 0.2], at: [0, " + std::to_string(1.2 + gap) + ", 0]}}\n";
  }

  std::filesystem::path folder_;
};

TEST_F(HeldPairs, AreTestedForAllStates) {
  EXPECT_THAT(pairsOf(problemOf(wallAt(1e-3))), IsEmpty());
  const Problem problem = problemOf(wallAt(-1e-3));
  EXPECT_THAT(pairsOf(problem), ElementsAre("lift ~ wall"));
  const Checker checker(problem);
  const Configuration from = startOf(problem), to = goalsOf(problem)[0];
  EXPECT_EQ(checker.certifyState(to).verdict, MotionVerdict::contact);
  const MotionResult edge = checker.certifyEdge(from, to, {.earliest = true});
  EXPECT_EQ(edge.verdict, MotionVerdict::contact);
  EXPECT_LE(edge.time, 1.0 / 1024);
  EXPECT_EQ(edge.certifiedUntil, 0);
  const std::vector<Checker::PairNotFree> pairs = checker.pairsNotFree(to);
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(problem.model.bodies[pairs[0].a].name, "lift");
  EXPECT_EQ(problem.model.bodies[pairs[0].b].name, "wall");
  EXPECT_FALSE(checker.isProvedFree(from));
  EXPECT_FALSE(checker.isProvedFree(from, to));
  EXPECT_EQ(checker.clearance(from), 0);
}

/// The pairs of a free problem are those that move: no time is lost on the others.
TEST_F(HeldPairs, CostNothingIfFree) {
  const Problem free = problemOf(wallAt(1e-3)), notFree = problemOf(wallAt(-1e-3));
  EXPECT_EQ(Checker(free).scene().pairs().size() + 1, Checker(notFree).scene().pairs().size());
  EXPECT_EQ(Checker(free).counters().states, 0u);
}

TEST_F(HeldPairs, KeepMarginAndPadding) {
  EXPECT_THAT(pairsOf(problemOf(wallAt(0.01) + "margin: 0.009\n")), IsEmpty());
  EXPECT_THAT(pairsOf(problemOf(wallAt(0.01) + "margin: 0.011\n")), ElementsAre("lift ~ wall"));
  EXPECT_THAT(pairsOf(problemOf(wallAt(0.01) + "margin: 0.009\npadding: {pairs: [[lift, wall, "
                                               "0.002]]}\n")),
              ElementsAre("lift ~ wall"));
  const Problem problem = problemOf(wallAt(0.01));
  EXPECT_EQ(Checker(problem.model).notFreeAtRest().size(), 0u);
  EXPECT_EQ(Checker(problem.model, {.margin = 0.2}).notFreeAtRest().size(), 1u)
      << "without the task of the problem";
}

TEST_F(HeldPairs, DependOnTheHeldValue) {
  EXPECT_THAT(pairsOf(problemOf(wallAt(-1e-3), "hold: {raise: 0.3}\n")), IsEmpty());
}

TEST_F(HeldPairs, AllowedOnesAreNotTested) {
  EXPECT_THAT(pairsOf(problemOf(wallAt(-1e-3) + "allow: [[lift, wall]]\n")), IsEmpty());
}

/// The hand can be held so that its lamp touches the arm. The lamp and the hand overlap always, but
/// only a fixed joint is between them.
TEST_F(HeldPairs, OfOneRobotOnAMovingLink) {
  EXPECT_THAT(pairsOf(problemOf("")), IsEmpty());
  std::ofstream(folder_ / "more.urdf")
      << "<robot name='arm'>" << ball("base") << ball("arm") << ball("left") << ball("right")
      << joint("turn", "revolute", "base", "arm", "0 0 1")
      << joint("a", "prismatic", "arm", "left", "0.5 0 0")
      << joint("b", "prismatic", "arm", "right", "0.5 0.15 0") << "</robot>";
  std::filesystem::rename(folder_ / "more.urdf", folder_ / "arm.urdf");
  EXPECT_THAT(pairsOf(problemOf("")), ElementsAre("left ~ right"));
  EXPECT_THAT(pairsOf(problemOf("", "hold: {a: 0.5}\n")), IsEmpty());
}

/// A joint whose limits are equal can't move in any problem. So it is like a fixed joint.
TEST_F(HeldPairs, NotOfJointsThatCanNotMove) {
  writeUrdf("<limit lower='0' upper='0' effort='1' velocity='1'/>");
  const Problem problem = problemOf(wallAt(-1e-3));
  EXPECT_THAT(pairsOf(problem), IsEmpty());
  EXPECT_EQ(leftOutOf(problem).except.size(), 1u) << "a note";
  writeUrdf("", "fixed");
  EXPECT_THAT(pairsOf(problemOf(wallAt(-1e-3))), IsEmpty());
  writeUrdf("", "floating");
  EXPECT_THAT(pairsOf(problemOf(wallAt(-1e-3))), ElementsAre("lift ~ wall"));
  EXPECT_THAT(pairsOf(problemOf(wallAt(-1e-3), "hold: {raise: {at: [0, -1, -1]}}\n")), IsEmpty());
  writeUrdf("<limit lower='-1' upper='1' effort='1' velocity='1'/><mimic joint='slide'/>");
  EXPECT_THAT(pairsOf(problemOf(wallAt(-1e-3))), ElementsAre("lift ~ wall"));
  EXPECT_THAT(pairsOf(problemOf(wallAt(-1e-3), "hold: {slide: 0.4}\n")), IsEmpty());
}

}  // namespace
}  // namespace corridor
