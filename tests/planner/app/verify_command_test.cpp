// Tests of the program `corridor verify`: solutions and trajectories. Solutions of other problems
// are tested in other_problem_test.cpp.
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/planner/app/program_fixtures.h"

namespace {

using testing::HasSubstr;
using testing::Not;

using VerifyCommand = corridor::test::CubeTest;
using VerifyTrajectory = corridor::test::ArmTest;

TEST_F(VerifyCommand, VerifyRefutes) {
  write("s.yaml",
        "format: corridor-solution-1\nspace: SE3\npath:\n- [-2, 0, 0, 0, 0, 0, "
        "1]\n- [2, 0, 0, 0, 0, 0, 1]\n");
  const Result verified = run("verify problem.yaml s.yaml");
  EXPECT_EQ(verified.status, 1);
  EXPECT_THAT(verified.out, HasSubstr("verdict: refuted\n"));
  EXPECT_THAT(verified.out, HasSubstr("solution: s.yaml\n"));
  EXPECT_THAT(verified.out, HasSubstr("finding: refuted: edge 0 at t = "));
  EXPECT_THAT(verified.out, HasSubstr("\"cube\" (triangle "));
  EXPECT_EQ(verified.err, "");
}

TEST_F(VerifyCommand, ReadsTheSolutionFromStandardInput) {
  write("s.yaml",
        "format: corridor-solution-1\nspace: SE3\npath:\n- [-2, 0, 0, 0, 0, 0, "
        "1]\n- [2, 0, 0, 0, 0, 0, 1]\n");
  const Result piped = run("verify problem.yaml -", "cat s.yaml | ");
  EXPECT_EQ(piped.status, 1) << piped.err;
  EXPECT_THAT(piped.out, HasSubstr("solution: -\nverdict: refuted\n"));
  EXPECT_EQ(run("verify problem.yaml - </dev/null").err,
            "-: is empty; a solution or a trajectory is needed\n");
  EXPECT_EQ(run("verify problem.yaml -", "echo x | ").status, 2);
}

TEST_F(VerifyCommand, BadInputIsOneLineAndExit2) {
  write("empty.yaml", "format: corridor-solution-1\nspace: SE3\npath: []\n");
  expectFault("verify problem.yaml empty.yaml",
              "empty.yaml:3: path: has no states; at least one is needed");
  expectFaultThatBegins("verify problem.yaml none.yaml", "none.yaml: ");
}

// With the elbow at 0, the arm reaches 1.9 m; it is 0.1 m wide. The post has the radius 0.1 m and
// is at (0, 1.5). So the arm first touches the post at a shoulder angle of π/2 − asin(0.15/1.5) =
// 1.4706.

TEST_F(VerifyTrajectory, ProvesRowsAndNotesStartAndGoal) {
  write("t.csv", "time,shoulder,elbow\n0,0,0\n1.5,0.5,-0.5\n");
  const Result proved = run("verify arm.yaml t.csv");
  EXPECT_EQ(proved.status, 0) << proved.err;
  EXPECT_THAT(proved.out, HasSubstr("trajectory: t.csv\nverdict: proved\n"));
  EXPECT_THAT(proved.out, HasSubstr("between rows: linear, from 0 s to 1.5 s\n"));
  EXPECT_THAT(proved.out, HasSubstr("edges proved: 1 of 1\n"));
  EXPECT_THAT(proved.out, HasSubstr("bounds: hold\n"));
  EXPECT_THAT(proved.out, HasSubstr("note: the trajectory does not end in the problem's goal: "));
  EXPECT_THAT(proved.out, Not(HasSubstr("does not begin")));
  EXPECT_EQ(run("verify arm.yaml - <t.csv").status, 0);
}

TEST_F(VerifyTrajectory, SaysWhenTheFirstContactIs) {
  // The shoulder moves at 1 rad/s from 10 s on.
  write("line.csv", "time,shoulder,elbow\n9,0,0\n10,0,0\n12.5,2.5,0\n");
  const auto first = [&](const std::string& arguments) {
    const Result refuted = run("verify arm.yaml " + arguments + " --json");
    EXPECT_EQ(refuted.status, 1) << refuted.err;
    return nlohmann::json::parse(refuted.out);
  };
  const auto line = first("line.csv");
  EXPECT_EQ(line["verdict"], "refuted");
  EXPECT_EQ(line["between"], "linear");
  EXPECT_EQ(line["begin_s"], 9);
  EXPECT_EQ(line["end_s"], 12.5);
  const auto& finding = line["findings"][0];
  EXPECT_EQ(finding["edge"], 1);
  EXPECT_EQ(finding["gap_m"], 0);
  const double angle = finding["state"][0];
  EXPECT_NEAR(angle, std::acos(0.1), 1e-6);
  EXPECT_NEAR(finding["time_s"].get<double>(), 10 + angle, 1e-9);
  EXPECT_NEAR(finding["free_until_s"].get<double>(), 10 + angle, 1e-6);
  EXPECT_THAT(run("verify arm.yaml line.csv").out, HasSubstr("finding: refuted: edge 1 at 11.4"));
  // The straight edge is free, but the velocity in the first row takes the arm to the post before
  // the arm turns back.
  write("cubic.yaml",
        "joint_names: [elbow, shoulder]\npoints:\n"
        "- {positions: [0, 0], velocities: [0, 8], time_from_start: {sec: 0, nanosec: 0}}\n"
        "- {positions: [0, 0.5], velocities: [0, 0], time_from_start: {sec: 1, nanosec: 500000000}}"
        "\n");
  EXPECT_EQ(run("verify arm.yaml cubic.yaml --between linear").status, 0);
  const auto cubic = first("cubic.yaml");
  EXPECT_EQ(cubic["between"], "cubic");
  EXPECT_NEAR(cubic["findings"][0]["state"][0].get<double>(), angle, 1e-6);
  // Closed form: q(τ) = 12·τ(1 − τ)² + 0.5·τ²(3 − 2τ), τ = t/1.5.
  const double tau = cubic["findings"][0]["time_s"].get<double>() / 1.5;
  EXPECT_NEAR(12 * tau * (1 - tau) * (1 - tau) + 0.5 * tau * tau * (3 - 2 * tau), angle, 1e-6);
}

TEST_F(VerifyTrajectory, BoundsAreProvedAlongTheWholeCurve) {
  // In the last row the elbow is at its limit, 2. Just before, it swings beyond this limit.
  write("t.csv", "time shoulder elbow shoulder_velocity elbow_velocity\n0 0 1.9 0 0\n1 0 2 0 -1\n");
  const Result refuted = run("verify arm.yaml t.csv");
  EXPECT_EQ(refuted.status, 1);
  EXPECT_THAT(refuted.out, HasSubstr("bounds: violated\nviolation: elbow = 2.0"));
  EXPECT_THAT(refuted.out, HasSubstr(" is outside of its bounds, [-2, 2]: at 0."));
  EXPECT_THAT(refuted.out, HasSubstr(" s, after line 2\n"));
  EXPECT_EQ(run("verify arm.yaml t.csv --between linear").status, 0);
}

TEST_F(VerifyTrajectory, AtMostTwentyFindingsArePrinted) {
  std::string rows = "shoulder elbow\n";  // the arm swings through the post 59 times
  for (int i = 0; i < 60; ++i) rows += i % 2 ? "1 0\n" : "2 0\n";
  write("t.csv", rows);
  const std::vector<std::string> printed = lines(run("verify arm.yaml t.csv").out);
  EXPECT_EQ(std::count_if(printed.begin(), printed.end(),
                          [](const std::string& line) { return line.starts_with("finding: "); }),
            21);
  EXPECT_THAT(printed, testing::Contains("finding: 39 more; --json has all of them"));
  const auto all = nlohmann::json::parse(run("verify arm.yaml t.csv --json").out);
  EXPECT_EQ(all["findings"].size(), 59u);
  write("t.csv", "shoulder elbow\n0 0\n0 100\n");
  EXPECT_THAT(run("verify arm.yaml t.csv").out,
              HasSubstr("; is it in degrees? These files have radians"));
}

TEST_F(VerifyTrajectory, BadInputIsOneLineAndExit2) {
  write("t.csv", "time,shoulder,elbow\n0,0,0\n0,0.5,-0.5\n");
  expectFault("verify arm.yaml t.csv",
              "t.csv:3: the time 0 s is not after that of the row before, 0 s; times must ascend");
  write("names.json",
        "{\"joint_names\": [\"shoulder\"], \"points\": [{\"positions\": [0]}, "
        "{\"positions\": [1]}]}");
  expectFault("verify arm.yaml names.json",
              "names.json:1: there is no column for elbow; all joints that are planned for need "
              "one");
  write("p.csv", "0 0\n0.5 0\n");
  expectFault("verify arm.yaml p.csv --between cubic",
              "p.csv: --between cubic needs times and velocities, which the file does not have; by "
              "default, linear is used");
  write("s.yaml",
        "format: corridor-solution-1\njoints: [shoulder, elbow]\npath:\n- [0, 0]\n- [1, 0]\n");
  expectFault("verify arm.yaml s.yaml --between linear",
              "--between: s.yaml is a solution, whose edges are linear; --between is for "
              "trajectories");
  expectFaultThatBegins("verify arm.yaml p.csv --between spline", "--between: ");
}

}  // namespace
