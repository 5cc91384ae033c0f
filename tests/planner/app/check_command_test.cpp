// Tests of the program `corridor check`: start and goals, and files of states.
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/planner/app/program_fixtures.h"

namespace {

using testing::HasSubstr;

using CheckCommand = corridor::test::ArmTest;

TEST_F(CheckCommand, CheckOfManyStates) {
  write("states.txt",
        "# shoulder elbow\n0, 0\n\n1.5708 0  # in the post\n2.9 -2\n0 2.5\n3.000001 0\n");
  const Result checked = run("check arm.yaml --states states.txt");
  EXPECT_EQ(checked.status, 1);
  EXPECT_EQ(checked.out, "state,valid,pairs\n0,1,\n1,0,lower~post\n2,1,\n3,0,bounds:elbow\n4,1,\n");
  EXPECT_EQ(
      checked.err,
      "corridor: warning: states.txt: in 1 state, values that exceeded a limit only by rounding "
      "were set to the limit\n");
  write("free.txt", "0 0\n0.1 0.1\n");
  EXPECT_EQ(run("check arm.yaml --states free.txt").status, 0);
  const auto json = nlohmann::json::parse(run("check arm.yaml --states states.txt --json").out);
  EXPECT_EQ(json["format"], "corridor-check-report-2");
  EXPECT_EQ(json["states"][1]["pairs"][0], "lower~post");
  EXPECT_EQ(json["states"][1]["line"], 4);
  EXPECT_EQ(json["states"][3]["out_of_bounds"][0], "elbow");
}

/// Angles of continuous joints are not wrapped, however large. A state is not valid if the angle is
/// so large that its rounding exceeds the clearance.
TEST_F(CheckCommand, CheckOfStatesTakesAnglesAsTheyAre) {
  std::string urdf = read("arm.urdf");
  const std::string revolute = "<joint name=\"shoulder\" type=\"revolute\">";
  urdf.replace(urdf.find(revolute), revolute.size(),
               "<joint name=\"shoulder\" type=\"continuous\">");
  write("arm.urdf", urdf);
  // The centre of the post is in the direction of 90 degrees. An angle of 1e6 rad points to 166.8
  // degrees, an angle of 1e15 rad to 143.9 degrees.
  write("states.txt", "1.5707963 0\n0.3 0\n1000000 0\n1000000.45 0\n-999998.7 0\n1e15 0\n1e22 0\n");
  const auto json = nlohmann::json::parse(run("check arm.yaml --states states.txt --json").out);
  const auto& states = json["states"];
  for (std::size_t i = 0; i < states.size(); ++i) {
    const double angle[] = {1.5707963, 0.3, 1000000, 1000000.45, -999998.7, 1e15, 1e22};
    // The arm, 2 m long, touches the sphere of radius 0.1 m at distance 1.5 m if it is within
    // 0.12 rad of the direction to the sphere's centre.
    const double off =
        std::remainder(static_cast<double>(std::atan2(std::sin(angle[i]), std::cos(angle[i]))) -
                           std::acos(-1.0) / 2,
                       2 * std::acos(-1.0));
    if (i < 5) {
      EXPECT_EQ(states[i]["valid"], std::abs(off) > 0.2) << i;
      EXPECT_FALSE(states[i].contains("too_large")) << i;
    } else {
      EXPECT_EQ(states[i]["valid"], false) << i;
      EXPECT_EQ(states[i]["too_large"], "shoulder") << i;
    }
  }
  EXPECT_THAT(run("check arm.yaml --states states.txt").out,
              testing::HasSubstr(";too_large:shoulder\n"));
}

/// The post of radius 0.1 m is at 1.5 m on the y axis. On an edge from 0 to 3 rad, a thin arm
/// touches the post at about t = (π/2 − asin(0.1/1.5)) / 3.
TEST_F(CheckCommand, CheckOfManyEdges) {
  write("edges.txt", "# shoulder elbow\n0 0  1 0\n0,0,3,0\n0 0 0 2.9\n");
  const Result checked = run("check arm.yaml --edges edges.txt");
  EXPECT_EQ(checked.status, 1);
  EXPECT_EQ(checked.err, "");
  EXPECT_THAT(checked.out, testing::MatchesRegex("edge,verdict,t0,t1,pair,reason\n"
                                                 "0,free,1,,,\n"
                                                 "1,contact,0\\.[0-9]*,0\\.[0-9]*,lower~post,\n"
                                                 "2,out_of_bounds,,,,bounds:elbow\n"));
  const auto json = nlohmann::json::parse(run("check arm.yaml --edges edges.txt --json").out);
  const auto& edges = json["edges"];
  EXPECT_EQ(edges[1]["line"], 3);
  const double t0 = edges[1]["t0"], t1 = edges[1]["t1"];
  EXPECT_LT(t0, t1);
  EXPECT_LT(t1 - t0, 1.0 / 512);
  EXPECT_NEAR(t1, (std::acos(-1.0) / 2 - std::asin(0.1 / 1.5)) / 3, 0.02);
  EXPECT_TRUE(edges[0]["t1"].is_null());
  write("free.txt", "0 0 1 0\n");
  EXPECT_EQ(run("check arm.yaml --edges free.txt").status, 0);
  write("limit.txt", "0 0  3.000001 0\n0.1 0 0.2 0\n");
  const Result limit = run("check arm.yaml --edges limit.txt");
  EXPECT_THAT(limit.err, HasSubstr("limit.txt: in 1 edge, values that exceeded a limit"));
  EXPECT_THAT(limit.out, HasSubstr("0,contact,"));
  write("first.txt", "1.5708 0 0 0\n");  // the edge begins in contact
  EXPECT_EQ(run("check arm.yaml --edges first.txt").out,
            "edge,verdict,t0,t1,pair,reason\n0,contact,0,0,lower~post,\n");

  const auto fault = [&](const std::string& text) {
    write("wrong.txt", text);
    const Result result = run("check arm.yaml --edges wrong.txt");
    EXPECT_EQ(result.status, 2);
    EXPECT_EQ(result.out, "");
    return result.err;
  };
  EXPECT_EQ(fault("0 0 1\n"),
            "wrong.txt:1: an edge has 4 numbers, those of its two states, not 3\n");
  EXPECT_EQ(fault("0 0 1 x\n"), "wrong.txt:1: a number is needed, not \"x\"\n");
  EXPECT_EQ(fault("# nothing\n"), "wrong.txt: no edges\n");
  EXPECT_EQ(fault(""), "wrong.txt: is empty; a file of edges, one per line, is needed\n");
  const Result both = run("check arm.yaml --edges free.txt --states free.txt");
  EXPECT_EQ(both.status, 2);
  EXPECT_THAT(both.err, HasSubstr("--edges"));
}

TEST_F(CheckCommand, CheckOfStatesFromAPipe) {
  const std::string states = "printf '0 0\\n1.5708 0\\n' | ";
  for (const char* input : {"-", "/dev/stdin", "/proc/self/fd/0"}) {
    const Result checked = run(std::string("check arm.yaml --states ") + input, states);
    EXPECT_EQ(checked.status, 1) << checked.err;
    EXPECT_EQ(checked.out, "state,valid,pairs\n0,1,\n1,0,lower~post\n") << input;
  }
  const Result wrong = run("check arm.yaml --states -", "echo 0 x | ");
  EXPECT_EQ(wrong.status, 2);
  EXPECT_EQ(wrong.err, "-:1: a number is needed, not \"x\"\n");
  EXPECT_EQ(run("check arm.yaml --states - </dev/null").err,
            "-: is empty; a file of states, one per line, is needed\n");
}

TEST_F(CheckCommand, StatesMayHaveAHeader) {
  write("states.csv", "# recorded\nelbow,shoulder\n0,1.5708\n2.5,0\n");
  EXPECT_EQ(run("check arm.yaml --states states.csv").out,
            "state,valid,pairs\n0,0,lower~post\n1,0,bounds:elbow\n");
  write("states.csv", "# elbow shoulder\n0 1.5708\n");  // as numpy.savetxt writes it
  EXPECT_EQ(run("check arm.yaml --states states.csv").out, "state,valid,pairs\n0,0,lower~post\n");
  write("states.csv", "\xEF\xBB\xBF\"elbow\",\"shoulder\"\n0,1.5708\n");  // as Excel does
  EXPECT_EQ(run("check arm.yaml --states states.csv").out, "state,valid,pairs\n0,0,lower~post\n");
  const auto fault = [&](const std::string& text) {
    write("states.csv", text);
    const Result checked = run("check arm.yaml --states states.csv");
    EXPECT_EQ(checked.status, 2);
    return checked.err;
  };
  EXPECT_EQ(fault("elbow shoulder time\n0 0 0\n"),
            "states.csv:1: the header has the column \"time\", which this problem's states do not "
            "have (known: "
            "shoulder, elbow)\n");
  EXPECT_EQ(fault("elbow elbow\n0 0\n"),
            "states.csv:1: the header names \"elbow\" twice\n"
            "states.csv:1: the header lacks shoulder\n");
  EXPECT_EQ(fault("shoulder elbow\n0 0 0\n"),
            "states.csv:2: a state has 2 numbers (shoulder elbow), not 3\n");
  EXPECT_EQ(fault("shoulder elbow\n"), "states.csv: no states\n");
}

/// If notes differ only in names, one of them is printed, with their number. --json lists all
/// notes.
TEST_F(CheckCommand, RepeatedNotesAreCounted) {
  std::string urdf = read("arm.urdf");
  for (const std::string effort : {" effort=\"1\"", " effort=\"1\""})
    if (const auto at = urdf.find(effort); at != urdf.npos) urdf.erase(at, effort.size());
  write("arm.urdf", urdf);
  const Result checked = run("check arm.yaml");
  EXPECT_THAT(checked.out, HasSubstr("note: arm.urdf:"));
  EXPECT_THAT(checked.out, HasSubstr("joint \"shoulder\": <limit> has no effort (and 1 similar "
                                     "note; inspect --json lists all)\n"));
  EXPECT_THAT(checked.out, testing::Not(HasSubstr("joint \"elbow\"")));
  for (const std::string file : {"arm.yaml", "arm.urdf"}) {
    const std::string text = run("inspect " + file).out;
    EXPECT_THAT(text, HasSubstr("<limit> has no effort (and 1 similar note; inspect --json lists "
                                "all)\n"));
    EXPECT_THAT(text, testing::Not(HasSubstr("joint \"elbow\": <limit>")));
    EXPECT_EQ(nlohmann::json::parse(run("inspect " + file + " --json").out)["notes"].size(), 2u);
  }
  EXPECT_EQ(nlohmann::json::parse(run("check arm.yaml --json").out)["notes"].size(), 2u);
}

/// Notes on what a proof covers come before other notes, and notes are printed even if there are
/// faults.
TEST_F(CheckCommand, NotesAreSortedAndPrintedWithFaults) {
  std::string urdf = read("arm.urdf");
  const std::string effort = " effort=\"1\"";
  for (auto at = urdf.find(effort); at != urdf.npos; at = urdf.find(effort))
    urdf.erase(at, effort.size());
  const std::string base = "<link name=\"base\"/>";
  urdf.replace(urdf.find(base), base.size(), "<link name=\"base\"><visual/></link>");
  write("arm.urdf", urdf);
  const std::string first =
      "arm.urdf:2: 1 link is not tested, having a <visual> and no <collision> (visuals: collide in "
      "robot.yaml uses the visuals): base";
  const std::string second = "arm.urdf:5: joint \"shoulder\": <limit> has no effort";
  const auto notes = nlohmann::json::parse(run("check arm.yaml --json").out)["notes"];
  ASSERT_EQ(notes.size(), 3u);
  EXPECT_EQ(notes[0], first);
  EXPECT_EQ(notes[1], second);

  const std::string more = "note: " + first + "\nnote: " + second + " (and 1 similar note)\n";
  write("faulty.yaml", read("arm.yaml") + "marginn: 1\n");
  const Result faulty = run("check faulty.yaml");
  EXPECT_EQ(faulty.status, 2);
  EXPECT_THAT(faulty.err, testing::StartsWith("faulty.yaml:7: unknown key \"marginn\""));
  EXPECT_THAT(faulty.err, testing::EndsWith("\n" + more));
  EXPECT_EQ(lines(faulty.err).size(), 3u);
  EXPECT_EQ(run("solve faulty.yaml faulty.yaml").err, faulty.err + faulty.err);

  // A robot that can't be used: its notes are printed, too.
  write("robot.yaml", "format: corridor-robot-1\nurdf: arm.urdf\nhold: {nothing: 1}\n");
  write("arm.urdf", urdf);
  const Result robot = run("inspect robot.yaml");
  EXPECT_EQ(robot.status, 2);
  EXPECT_THAT(robot.err, testing::StartsWith("robot.yaml:3: "));
  EXPECT_THAT(robot.err, testing::EndsWith(more));
}

TEST_F(CheckCommand, CheckQuotesNamesWithCommas) {
  write("commas.yaml",
        "format: corridor-problem-1\nrobot: arm.urdf\nworld: {'post \"a\", b': {sphere: 0.1, at: "
        "[0, 1.5, 0]}}\nstart: {shoulder: 0, elbow: 0}\ngoal: {shoulder: 2.8, elbow: 0.5}\n");
  write("states.txt", "1.5708 0\n");
  EXPECT_EQ(run("check commas.yaml --states states.txt").out,
            "state,valid,pairs\n0,0,\"lower~post \"\"a\"\", b\"\n");
}

TEST_F(CheckCommand, ReportsFaultyStatesByLine) {
  write("states.txt", "0 0 0\n0 0\n0 x\n");
  const Result checked = run("check arm.yaml --states states.txt");
  EXPECT_EQ(checked.status, 2);
  EXPECT_EQ(checked.err,
            "states.txt:1: a state has 2 numbers (shoulder elbow), not 3\n"
            "states.txt:3: a number is needed, not \"x\"\n");
  EXPECT_EQ(checked.out, "");
}

TEST_F(CheckCommand, CheckOfStartAndGoal) {
  const Result sound = run("check arm.yaml");
  EXPECT_EQ(sound.status, 0) << sound.err;
  EXPECT_EQ(sound.out,
            "problem: arm.yaml\nstart: free\ngoal: free\n"
            "not tested: 1 pair: 1 adjacent\n");
  write("touch.yaml",
        "format: corridor-problem-1\nrobot: arm.urdf\nworld:\n  post: {sphere: 0.1, at: [0, 1.5, "
        "0]}\n"
        "start: {shoulder: 1.57, elbow: 0}\ngoal: {shoulder: 2.8, elbow: 0.5}\n");
  const Result touch = run("check touch.yaml");
  EXPECT_EQ(touch.status, 1);
  EXPECT_THAT(touch.out, HasSubstr("start: in contact: \"lower\" and \"post\" touch; the "
                                   "nearest free values found are at most 0."));
  // The message has the values of all joints, even of an unchanged one, so that they can be copied
  // into the problem.
  EXPECT_THAT(touch.out, testing::ContainsRegex("\\{shoulder: [0-9.]+, elbow: [-0-9.e]+\\}"));
  write("bad.yaml",
        "format: corridor-problem-1\nrobot: arm.urdf\nworld:\n  post: {sphere: 0.1, at: [0, 1.5, "
        "0]}\n"
        "start: {shoulder: 0, elbow: 0}\ngoal: {shoulder: 2.8, elbow: 0.5}\n"
        "planner: {name: RRT, params: {rnge: 1, goal_bias: 2}}\n");
  const Result bad = run("check bad.yaml");
  EXPECT_EQ(bad.status, 2);
  EXPECT_THAT(bad.err, HasSubstr("bad.yaml:7: RRT has no parameter \"rnge\""));
  EXPECT_THAT(bad.err, HasSubstr("bad.yaml:7: RRT's parameter goal_bias"));  // both faults
}

TEST_F(CheckCommand, BadInputIsOneLineAndExit2) {
  expectFault("check arm.yaml --states .", ".: is a folder; a file is needed");
  expectFault("check arm.yaml --states /dev/zero",
              "/dev/zero: is a device; an ordinary file is needed");
}

}  // namespace
