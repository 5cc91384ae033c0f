// Tests of bodies that are in contact, or too close, in every state, because the joints between
// them are held: the planner refuses such a problem, and the verifier refutes every path.
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "planner/checker/problem_goal.h"
#include "planner/solve/verify_solution.h"
#include "planner/solve/why_not_free.h"
#include "tests/planner/solve/complaint.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using testing::StartsWith;

/// A crane that turns, with a hook 1 m out on a held winch, over a floor whose upper face is at
/// z = 0. The ball of the hook is at z = 1 − winch.
class RestContact : public testing::Test {
 protected:
  RestContact() : folder_(test::newFolder()) {
    const auto ball = [](const std::string& name) {
      return "<link name='" + name +
             "'><collision><geometry><sphere radius='0.1'/></geometry></collision></link>";
    };
    const std::string limits = "<limit lower='-3' upper='3' effort='1' velocity='1'/></joint>";
    std::ofstream(folder_ / "crane.urdf")
        << "<robot name='crane'>" << ball("mast") << ball("hook") << ball("lamp")
        << "<joint name='turn' type='revolute'><parent link='mast'/><child link='lamp'/>"
           "<origin xyz='0 1 1'/><axis xyz='0 0 1'/>"
        << limits
        << "<joint name='winch' type='prismatic'><parent link='mast'/><child link='hook'/>"
           "<origin xyz='1 0 1'/><axis xyz='0 0 -1'/>"
        << limits << "</robot>";
  }
  ~RestContact() override { std::filesystem::remove_all(folder_); }

  /// @param gap of hook and floor, m.
  Problem problemOf(double gap, const std::string& keys = "") {
    std::ofstream robot(folder_ / "robot.yaml");
    robot.precision(17);
    robot << "format: corridor-robot-1\nurdf: crane.urdf\njoints: [turn]\nhold: {winch: "
          << 0.9 - gap << "}\n";
    robot.close();
    std::ofstream(folder_ / "p.yaml") << "format: corridor-problem-1\nrobot: robot.yaml\n"
                                         "world: {floor: {box: [3, 3, 0.2], at: [1.9, 0, -0.1]}}\n"
                                         "start: {turn: 0}\ngoal: {turn: 1}\n"
                                      << keys;
    return readProblem(folder_ / "p.yaml");
  }
  static std::string whyNot(const Problem& problem) {
    return whyNotFree(startOf(problem), Checker(problem)).value_or("free");
  }
  static Solution straight(const Problem& problem) {
    Solution solution;
    solution.path = {startOf(problem), goalsOf(problem)[0]};
    return solution;
  }

  std::filesystem::path folder_;
};

const std::string kAdvice =
    ", and the joint between them, \"winch\", is held; hold it at another value, or add allow: "
    "[[hook, floor]] if this is intended";

TEST_F(RestContact, IsExplained) {
  EXPECT_EQ(whyNot(problemOf(0.1)), "free");
  EXPECT_EQ(whyNot(problemOf(-0.01)),
            "in contact in every state: \"hook\" and \"floor\" touch" + kAdvice);
  EXPECT_EQ(whyNot(problemOf(0.25, "margin: 0.5\n")),
            "too close in every state: \"hook\" and \"floor\" are 0.25 m apart, and more than the "
            "margin of 0.5 m is needed" +
                kAdvice)
      << "only fixed joints are between the mast and the floor, which are 0.3 m apart";
  EXPECT_EQ(whyNot(problemOf(0.25, "padding: {pairs: [[hook, floor, 0.5]]}\n")),
            "too close in every state: \"hook\" and \"floor\" are 0.25 m apart, and more than the "
            "margin and padding of 0.5 m is needed" +
                kAdvice);
  EXPECT_THAT(whyNot(problemOf(0.25, "checker: {tolerance: 0.5}\n")),
              StartsWith("the gap between \"hook\" and \"floor\" is 0.25 m in every state, too "
                         "small to prove at a tolerance of 0.5 m" +
                         kAdvice));
}

/// A second hook, on a winch of its own, is near the floor; the first one touches it.
TEST_F(RestContact, NamesAPairThatTouchesFirst) {
  std::string urdf = test::contents(folder_ / "crane.urdf");
  urdf.replace(urdf.find("</robot>"), 8,
               "<link name='axe'><collision><geometry><sphere radius='0.1'/></geometry></collision>"
               "</link><joint name='rope' type='prismatic'><parent link='mast'/><child link='axe'/>"
               "<origin xyz='1 1 0.2'/><axis xyz='0 0 1'/><limit lower='-3' upper='3' effort='1' "
               "velocity='1'/></joint></robot>");
  std::ofstream(folder_ / "crane.urdf") << urdf;
  EXPECT_EQ(whyNot(problemOf(-0.01, "margin: 0.2\n")),
            "in contact in every state: \"hook\" and \"floor\" touch" + kAdvice +
                "; not proved free either: \"axe\" and \"floor\"");
  EXPECT_THAT(whyNot(problemOf(0.5, "margin: 0.2\n")),
              StartsWith("too close in every state: \"axe\" and \"floor\" are 0.1 m apart, "));
}

TEST_F(RestContact, IsRefusedByThePlanner) {
  const std::string file = (folder_ / "p.yaml").string();
  EXPECT_EQ(test::complaintOf(problemOf(-0.01)),
            file + ":4: start: in contact in every state: \"hook\" and \"floor\" touch" + kAdvice);
  EXPECT_EQ(test::complaintOf(problemOf(0.1)), "");
  EXPECT_EQ(test::complaintOf(problemOf(-0.01, "allow: [[hook, floor]]\n")), "");
  EXPECT_EQ(test::complaintOf(problemOf(-0.01, "checker: {edges: discrete}\n")),
            file + ":4: start: in contact in every state: \"hook\" and \"floor\" touch" + kAdvice);
}

TEST_F(RestContact, IsRefutedByTheVerifier) {
  const Problem problem = problemOf(-0.01);
  EXPECT_EQ(plainProblem(problem).heldPairs.size(), 1u) << "hook and floor";
  const VerifyReport report = verifySolution(problem, straight(problem));
  EXPECT_EQ(report.verdict, PathVerdict::refuted);
  EXPECT_EQ(firstFinding(report), "in every state: contact: hook and floor");
  TrajectoryRows rows;
  rows.timed = true;
  for (const double time : {0.0, 1.0}) {
    TrajectoryRow& row = rows.rows.emplace_back();
    row.time = time;
    row.positions = Configuration::Constant(1, time);
  }
  const VerifyReport ofRows = verifyTrajectory(problem, rows, RowInterpolation::linear);
  EXPECT_EQ(ofRows.verdict, PathVerdict::refuted);
  EXPECT_EQ(firstFinding(ofRows), "in every state: contact: hook and floor");

  for (const Problem& free : {problemOf(0.1), problemOf(-0.01, "allow: [[hook, floor]]\n")}) {
    EXPECT_EQ(verifySolution(free, straight(free)).verdict, PathVerdict::proved);
    EXPECT_EQ(verifyTrajectory(free, rows, RowInterpolation::linear).verdict, PathVerdict::proved);
  }
}

TEST_F(RestContact, ReportsWhatIsLeftOut) {
  const Problem problem = problemOf(-0.01, "allow: [[hook, floor]]\n");
  SolveOptions options;
  EXPECT_TRUE(solveProblem(problem, options).leftOut.except.empty()) << "only if wanted";
  options.noteLeftOut = true;
  const SolveReport report = solveProblem(problem, options);
  EXPECT_TRUE(report.certified);
  ASSERT_EQ(report.leftOut.except.size(), 1u);
  EXPECT_EQ(report.leftOut.except[0].reason, LeftOutReason::allowed);
}

}  // namespace
}  // namespace corridor
