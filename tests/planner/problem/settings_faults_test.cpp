// Faults in the settings of a problem: padding, clearance, trajectories.
#include "tests/planner/problem/problem_faults.h"

namespace corridor::test {
namespace {

TEST_F(ProblemFaults, Margin) {
  EXPECT_EQ(with("margin: {}\n"), "problem.yaml:8: margin: self, world or pairs is needed");
  EXPECT_EQ(with("margin: {self: -1}\n"), "problem.yaml:8: margin.self: must be 0 or more, not -1");
  EXPECT_EQ(with("margin: {links: 1}\n"),
            "problem.yaml:8: unknown key \"links\" in margin (known: self, world, pairs)");
  EXPECT_EQ(with("margin: {pairs: [[rock, wedge, 1], [wedge, rock, 2]]}\n"),
            "problem.yaml:8: margin.pairs: the pair has two margins");
  EXPECT_EQ(
      with("margin: {pairs: [[rock, rook, 1]]}\n"),
      "problem.yaml:8: margin.pairs: there is no body \"rook\" (did you mean \"rock\"?) (known: "
      "wedge, rock)");
  EXPECT_EQ(with("margin: [1, 2]\n"),
            "problem.yaml:8: margin: a number or a map {self: …, world: …} is needed, not a list");
  for (const char* huge : {"margin: {self: 0, world: 1.79e308}\npadding: {bodies: {rock: 1e307}}\n",
                           "margin: 1.7976931348623157e308\n"})
    EXPECT_EQ(with(huge), "problem.yaml:8: margin: margin and padding are too large");
  EXPECT_EQ(with("margin: {self: 0, world: 0.01}\nprefer: {clearance: 0.005}\n"), "no complaint");
}

TEST_F(ProblemFaults, Padding) {
  const auto known = " (known: wedge, rock)";
  EXPECT_EQ(with("padding: {bodies: {hand: 0.1}}\n"),
            std::string("problem.yaml:8: padding.bodies.hand: there is no body \"hand\"") + known);
  EXPECT_EQ(with("padding: {bodies: {rock: -0.1}}\n"),
            "problem.yaml:8: padding.bodies.rock: must be 0 or more, not -0.1");
  EXPECT_EQ(with("padding: {bodies: {rock: .nan}}\n"),
            "problem.yaml:8: padding.bodies.rock: a finite number is needed, not \".nan\"");
  EXPECT_EQ(with("padding: {links: {rock: 1}}\n"),
            "problem.yaml:8: unknown key \"links\" in padding (known: bodies, pairs)");
  EXPECT_EQ(with("padding: {pairs: rock}\n"),
            "problem.yaml:8: padding.pairs: a list of pairs is needed, each with its padding in "
            "metres, such as [hand, shelf, 0.02]");
  EXPECT_EQ(with("padding: {pairs: [[rock, wedge]]}\n"),
            "problem.yaml:8: padding.pairs: two bodies and a padding in metres are needed, such as "
            "[hand, shelf, 0.02]");
  EXPECT_EQ(with("padding: {pairs: [[rock, wedge, far]]}\n"),
            "problem.yaml:8: padding.pairs: a number is needed, not \"far\"");
  EXPECT_EQ(with("padding: {pairs: [[rock, rock, 1]]}\n"),
            "problem.yaml:8: padding.pairs: two different bodies are needed, such as [hand, shelf, "
            "0.02]");
  EXPECT_EQ(with("padding: {pairs: [[rock, wedge, 1], [wedge, rock, 2]]}\n"),
            "problem.yaml:8: padding.pairs: the pair has two paddings");
  EXPECT_EQ(with("padding: {pairs: [[rock, rook, 1]]}\n"),
            std::string("problem.yaml:8: padding.pairs: there is no body \"rook\" (did you mean "
                        "\"rock\"?)") +
                known);
}

TEST_F(ProblemFaults, Prefer) {
  EXPECT_EQ(with("prefer: {clearance: -1}\n"),
            "problem.yaml:8: prefer.clearance: must be 0 or more, not -1");
  EXPECT_EQ(with("prefer: {clearance: .inf}\n"),
            "problem.yaml:8: prefer.clearance: a finite number is needed, not \".inf\"");
  EXPECT_EQ(with("prefer: {detour: -0.1}\n"),
            "problem.yaml:8: prefer.detour: must be 0 or more, not -0.1");
  EXPECT_EQ(with("prefer: {detour: .nan}\n"),
            "problem.yaml:8: prefer.detour: a finite number is needed, not \".nan\"");
  EXPECT_EQ(with("prefer: 0.1\n"),
            "problem.yaml:8: prefer: a map such as {clearance: …} is needed, not \"0.1\"");
  EXPECT_EQ(with("prefer: {margin: 1}\n"),
            "problem.yaml:8: unknown key \"margin\" in prefer (did you mean margin: … at the top "
            "level?) (known: clearance, detour, clearance_of)");
  const std::string place = "problem.yaml:9: prefer.clearance: ";
  EXPECT_EQ(with("margin: 0.01\nprefer: {clearance: 0.1}\n"),
            place + "can't be used if every pair has a margin; leave one of the two out");
  for (const char* other : {"simplify: false\n", "simplify: ompl\n"})
    EXPECT_EQ(with(std::string(other) + "prefer: {clearance: 0.1}\n"),
              place +
                  "needs Corridor's simplifier; leave out simplify: false or ompl "
                  "(--no-simplify, --simplify)");
  EXPECT_EQ(with("checker: {edges: discrete}\nprefer: {clearance: 0.1}\n"),
            place + "needs edges that are proved; discrete edges are only sampled");
  EXPECT_EQ(with("margin: 0.01\nprefer: {clearance: 0, detour: 0}\n"), "no complaint");
}

TEST_F(ProblemFaults, Trajectory) {
  EXPECT_EQ(
      with("trajectory: {smooth: tme}\n"),
      "problem.yaml:8: trajectory.smooth: one of none, corners, time, length, acceleration is "
      "needed, not \"tme\" (did you mean \"time\"?)");
  EXPECT_EQ(with("trajectory: {rate: 0.5}\n"),
            "problem.yaml:8: trajectory.rate: a number from 1 to 10000 is needed, not 0.5");
  EXPECT_EQ(with("trajectory: {deviation: 2}\n"),
            "problem.yaml:8: trajectory.deviation: a number from 1e-09 to 1 is needed, not 2");
  EXPECT_EQ(with("trajectory: {corner_deviation: -1}\n"),
            "problem.yaml:8: trajectory.corner_deviation: must be above 0, not -1");
  EXPECT_EQ(with("trajectory: {speed: 1}\n"),
            "problem.yaml:8: unknown key \"speed\" in trajectory (known: smooth, deviation, "
            "corner_deviation, rate)");
}

}  // namespace
}  // namespace corridor::test
