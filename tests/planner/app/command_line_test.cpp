// Tests of the program from outside: exit statuses, one line per fault, results on stdout, no
// incomplete files.
#include <algorithm>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/planner/app/program_test.h"

namespace {

using testing::HasSubstr;
using testing::StartsWith;

using corridor::test::ProgramTest;

class CommandLine : public ProgramTest {
 protected:
  CommandLine() {
    write("cube.obj",
          "v -.1 -.1 -.1\nv .1 -.1 -.1\nv .1 .1 -.1\nv -.1 .1 -.1\nv -.1 -.1 .1\nv .1 -.1 .1\nv .1 "
          ".1 .1\nv -.1 .1 .1\n"
          "f 1 3 2\nf 1 4 3\nf 5 6 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\nf 3 4 8\nf 3 8 7\nf 2 3 7\nf 2 7 "
          "6\nf 1 5 8\nf 1 8 4\n");
    write("wall.obj", "v 0 -5 -5\nv 0 2 -5\nv 0 2 5\nv 0 -5 5\nf 1 2 3\nf 1 3 4\n");
    write(
        "robot.yaml",
        "format: corridor-robot-1\nname: cube\nrigid: SE3\nshapes: [{mesh: cube.obj, unit: m}]\n");
    write("problem.yaml", problem());
  }

  static std::string problem(const std::string& start = "-2, 0, 0", const std::string& more = "") {
    return "format: corridor-problem-1\nrobot: robot.yaml\nworld:\n  wall: {mesh: wall.obj, unit: "
           "m}\nstart: {at: [" +
           start + "]}\ngoal: {at: [2, 0, 0]}\nbounds: {at: [[-4, -4, -4], [4, 4, 4]]}\n" + more;
  }
};

/// `check` and `solve` must report it, too, if an angle was wrapped: not only `inspect`.
TEST_F(CommandLine, WhatWasReadDifferentlyIsTold) {
  write("arm.urdf",
        "<robot name='arm'><link name='a'/><link name='b'><collision><geometry><box size='1 1 1'/>"
        "</geometry></collision></link><joint name='pan' type='continuous'><parent link='a'/>"
        "<child link='b'/><axis xyz='0 0 1'/></joint></robot>");
  write("arm.yaml",
        "format: corridor-problem-1\nrobot: arm.urdf\nworld:\n  post: {box: [1, 1, 1], at: [5, 0, "
        "0]}\nstart: {pan: -60}\ngoal: {pan: 0}\n");
  for (const char* command : {"check", "solve", "inspect"}) {
    const Result told = run(command + std::string(" arm.yaml"));
    EXPECT_EQ(told.status, 0) << told.err;
    EXPECT_THAT(told.out, HasSubstr("note: start.pan: -60 is read as 2.83185307179586")) << command;
    if (command == std::string("inspect")) continue;
    const Result json = run(command + std::string(" arm.yaml --json"));
    EXPECT_THAT(json.out, HasSubstr("start.pan: -60 is read as 2.83185307179586")) << command;
  }
}

TEST_F(CommandLine, SolveThenVerify) {
  const Result solved = run("solve problem.yaml -o s.yaml --picture p.svg");
  EXPECT_EQ(solved.status, 0) << solved.err;
  EXPECT_THAT(solved.out, HasSubstr("result: solved\n"));
  EXPECT_THAT(solved.out, HasSubstr("certified: yes\n"));
  EXPECT_THAT(solved.out, testing::ContainsRegex("path length: [0-9.]+ m, turning [0-9.]+ rad\n"));
  EXPECT_EQ(solved.err, "");
  EXPECT_THAT(read("p.svg"), StartsWith("<svg"));
  EXPECT_LT(std::filesystem::file_size(folder_ / "p.svg"), 400'000u);
  const Result verified = run("verify problem.yaml s.yaml");
  EXPECT_EQ(verified.status, 0) << verified.err << verified.out;
  EXPECT_THAT(verified.out, HasSubstr("verdict: proved\n"));
  EXPECT_THAT(verified.out, HasSubstr("clearance: at least "));
}

TEST_F(CommandLine, VerifyRefutes) {
  write("s.yaml",
        "format: corridor-solution-1\nspace: SE3\npath:\n- [-2, 0, 0, 0, 0, 0, "
        "1]\n- [2, 0, 0, 0, 0, 0, 1]\n");
  const Result verified = run("verify problem.yaml s.yaml");
  EXPECT_EQ(verified.status, 1);
  EXPECT_THAT(verified.out, HasSubstr("verdict: refuted\n"));
  EXPECT_THAT(verified.out, HasSubstr("finding: refuted: edge 0 at t = "));
  EXPECT_THAT(verified.out, HasSubstr("\"cube\" (triangle "));
  EXPECT_EQ(verified.err, "");
}

TEST_F(CommandLine, JsonIsVersionedAndComplete) {
  const auto solved = nlohmann::json::parse(run("solve problem.yaml --json -o s.yaml").out);
  EXPECT_EQ(solved["format"], "corridor-solve-report-1");
  EXPECT_EQ(solved["problems"][0]["result"], "solved");
  EXPECT_EQ(solved["problems"][0]["certified"], true);
  EXPECT_EQ(nlohmann::json::parse(run("verify problem.yaml s.yaml --json").out)["verdict"],
            "proved");
  const auto mesh = nlohmann::json::parse(run("inspect cube.obj --json --self-intersections").out);
  EXPECT_EQ(mesh["mesh"]["self_intersections"], nlohmann::json::array());
  EXPECT_EQ(mesh["mesh"]["triangles"], 12);
  EXPECT_EQ(mesh["mesh"]["watertight"], true);
  EXPECT_GT(mesh["tree"]["nodes"], 1);
  EXPECT_GE(mesh["tree"]["binary_depth"], 4);  // twelve leaves need four levels
  EXPECT_EQ(nlohmann::json::parse(run("inspect problem.yaml --json").out)["pairs"]["tested"], 1);
}

/// An arm of two links with revolute joints about z, and a post beside it.
class ArmCommandLine : public CommandLine {
 protected:
  ArmCommandLine() {
    write(
        "arm.urdf",
        "<robot name=\"arm\">\n"
        "<link name=\"base\"/>\n"
        "<link name=\"upper\"><collision><origin xyz=\"0.5 0 0\"/><geometry><box size=\"0.8 0.1 "
        "0.1\"/></geometry></collision></link>\n"
        "<link name=\"lower\"><collision><origin xyz=\"0.5 0 0\"/><geometry><box size=\"0.8 0.1 "
        "0.1\"/></geometry></collision></link>\n"
        "<joint name=\"shoulder\" type=\"revolute\"><parent link=\"base\"/><child link=\"upper\"/>"
        "<axis xyz=\"0 0 1\"/><limit lower=\"-3\" upper=\"3\" effort=\"1\" "
        "velocity=\"1\"/></joint>\n"
        "<joint name=\"elbow\" type=\"revolute\"><parent link=\"upper\"/><child link=\"lower\"/>"
        "<origin xyz=\"1 0 0\"/><axis xyz=\"0 0 1\"/><limit lower=\"-2\" upper=\"2\" effort=\"1\" "
        "velocity=\"1\"/></joint>\n"
        "</robot>\n");
    write("arm.yaml",
          "format: corridor-problem-1\nrobot: arm.urdf\nworld:\n  post: {sphere: 0.1, at: [0, 1.5, "
          "0]}\n"
          "start: {shoulder: 0, elbow: 0}\ngoal: {shoulder: 2.8, elbow: 0.5}\n");
  }
};

TEST_F(ArmCommandLine, SolveThenVerify) {
  const Result solved = run("solve arm.yaml -o s.yaml --picture p.svg");
  EXPECT_EQ(solved.status, 0) << solved.err;
  EXPECT_THAT(solved.out, HasSubstr("certified: yes\n"));
  EXPECT_THAT(solved.out, testing::ContainsRegex("path length: [0-9.]+ rad\n"));
  EXPECT_THAT(read("s.yaml"), HasSubstr("joints: [\"shoulder\", \"elbow\"]\n"));
  EXPECT_THAT(read("p.svg"), StartsWith("<svg"));
  const Result verified = run("verify arm.yaml s.yaml");
  EXPECT_EQ(verified.status, 0) << verified.err << verified.out;
  write("s.yaml",
        "format: corridor-solution-1\njoints: [shoulder, elbow]\npath: [[0, 0], [2.8, 0.5]]\n");
  const Result refuted = run("verify arm.yaml s.yaml");
  EXPECT_EQ(refuted.status, 1);
  EXPECT_THAT(refuted.out, HasSubstr("\"lower\" and \"post\""));
  EXPECT_THAT(refuted.out, HasSubstr("; at shoulder = "));
}

TEST_F(ArmCommandLine, CheckOfManyStates) {
  write("states.txt",
        "# shoulder elbow\n0, 0\n\n1.5708 0  # in the post\n2.9 -2\n0 2.5\n3.000001 0\n");
  const Result checked = run("check arm.yaml --states states.txt");
  EXPECT_EQ(checked.status, 1);
  EXPECT_EQ(checked.out, "state,valid,pairs\n0,1,\n1,0,lower~post\n2,1,\n3,0,bounds:elbow\n4,1,\n");
  EXPECT_EQ(
      checked.err,
      "corridor: warning: states.txt: in 1 state, values beyond a limit by no more than rounding "
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
TEST_F(ArmCommandLine, CheckOfStatesTakesAnglesAsTheyAre) {
  std::string urdf = read("arm.urdf");
  const std::string revolute = "<joint name=\"shoulder\" type=\"revolute\">";
  urdf.replace(urdf.find(revolute), revolute.size(),
               "<joint name=\"shoulder\" type=\"continuous\">");
  write("arm.urdf", urdf);
  // The post's centre is at 90 degrees; 1e6 rad point to 166.8 degrees, 1e15 rad to 143.9.
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

TEST_F(ArmCommandLine, CheckOfStatesFromAPipe) {
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
            "-: is empty; states, one a line is needed\n");
}

/// Joints may have any names: the joints' types decide whether a problem has a rigid body.
TEST_F(ArmCommandLine, AnArmOfJointsCalledXYAndYawIsNoRigidBody) {
  std::string urdf = "<robot name=\"arm\">\n<link name=\"l0\"/>\n", parent = "l0";
  for (const std::string name : {"x", "y", "yaw"}) {
    urdf += "<link name=\"" + name +
            "\"><collision><geometry><sphere radius=\"0.1\"/></geometry>"
            "</collision></link>\n<joint name=\"" +
            name + "\" type=\"revolute\"><parent link=\"" + parent + "\"/><child link=\"" + name +
            "\"/><origin xyz=\"0.5 0 0\"/><axis xyz=\"0 0 1\"/>"
            "<limit lower=\"-2\" upper=\"2\" effort=\"1\" velocity=\"1\"/></joint>\n";
    parent = name;
  }
  write("arm.urdf", urdf + "</robot>\n");
  write(
      "arm.yaml",
      "format: corridor-problem-1\nrobot: arm.urdf\nworld: {post: {sphere: 0.1, at: [0, 1.5, 0]}}\n"
      "start: {x: 0, y: 0, yaw: 0}\ngoal: {x: 1, y: 0, yaw: 0}\n");
  EXPECT_EQ(nlohmann::json::parse(run("inspect arm.yaml --json").out)["space"], "joints");
  // Three joints 0.5 m apart, and a sphere of radius 0.1 m.
  EXPECT_THAT(run("inspect arm.urdf").out,
              HasSubstr("reach: at most 1.6 m from the origin of l0: link yaw\n"));
  EXPECT_EQ(run("solve arm.yaml -o s.yaml").status, 0);
  EXPECT_THAT(read("s.yaml"), HasSubstr("joints: [\"x\", \"y\", \"yaw\"]\n"));
  EXPECT_EQ(run("verify arm.yaml s.yaml").status, 0);
  write("s.yaml", "format: corridor-solution-1\nspace: SE2\npath: [[0, 0, 0], [1, 0, 0]]\n");
  EXPECT_EQ(
      run("verify arm.yaml s.yaml").err,
      "s.yaml:2: space: the problem is in the joints [\"x\", \"y\", \"yaw\"], this solution in "
      "SE2\n");
  write("states.txt", "0 0\n");
  EXPECT_EQ(run("check arm.yaml --states states.txt").err,
            "states.txt:1: a state has 3 numbers (x y yaw), not 2\n");
}

TEST_F(ArmCommandLine, CheckQuotesNamesWithCommas) {
  write("commas.yaml",
        "format: corridor-problem-1\nrobot: arm.urdf\nworld: {'post \"a\", b': {sphere: 0.1, at: "
        "[0, 1.5, 0]}}\nstart: {shoulder: 0, elbow: 0}\ngoal: {shoulder: 2.8, elbow: 0.5}\n");
  write("states.txt", "1.5708 0\n");
  EXPECT_EQ(run("check commas.yaml --states states.txt").out,
            "state,valid,pairs\n0,0,\"lower~post \"\"a\"\", b\"\n");
}

TEST_F(ArmCommandLine, CheckFaultsStatesByLine) {
  write("states.txt", "0 0 0\n0 0\n0 x\n");
  const Result checked = run("check arm.yaml --states states.txt");
  EXPECT_EQ(checked.status, 2);
  EXPECT_EQ(checked.err,
            "states.txt:1: a state has 2 numbers (shoulder elbow), not 3\n"
            "states.txt:3: a number is needed, not \"x\"\n");
  EXPECT_EQ(checked.out, "");
}

TEST_F(ArmCommandLine, CheckOfStartAndGoal) {
  const Result sound = run("check arm.yaml");
  EXPECT_EQ(sound.status, 0) << sound.err;
  EXPECT_EQ(sound.out, "problem: arm.yaml\nstart: free\ngoal: free\n");
  write("touch.yaml",
        "format: corridor-problem-1\nrobot: arm.urdf\nworld:\n  post: {sphere: 0.1, at: [0, 1.5, "
        "0]}\n"
        "start: {shoulder: 1.57, elbow: 0}\ngoal: {shoulder: 2.8, elbow: 0.5}\n");
  const Result touch = run("check touch.yaml");
  EXPECT_EQ(touch.status, 1);
  EXPECT_THAT(touch.out, HasSubstr("start: start is in contact: \"lower\" and \"post\" touch; the "
                                   "nearest free values found are at most 0."));
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

TEST_F(ArmCommandLine, InspectTellsPairsAndRobots) {
  const Result problem = run("inspect arm.yaml --pairs");
  EXPECT_EQ(problem.status, 0) << problem.err;
  EXPECT_THAT(problem.out, HasSubstr("joint: \"elbow\": -2 to 2 rad\n"));
  EXPECT_THAT(problem.out, HasSubstr("pair: upper~lower: not tested: adjacent\n"));
  EXPECT_THAT(problem.out, HasSubstr("pair: lower~post: tested\n"));
  EXPECT_THAT(problem.out, HasSubstr("pairs tested: 2\n"));
  EXPECT_THAT(problem.out, HasSubstr("pairs skipped: 1: adjacent\n"));
  const auto json = nlohmann::json::parse(run("inspect arm.yaml --json").out);
  EXPECT_EQ(json["pairs"]["tested"], 2);
  EXPECT_EQ(json["pair_list"].size(), 3u);
  double share = 0;
  for (const auto& pair : json["random_edges"]["pairs"]) share += pair["share"].get<double>();
  EXPECT_NEAR(share, 1, 1e-9);
  EXPECT_EQ(json["random_edges"]["pairs"].size(), 2u);
  EXPECT_GT(json["random_edges"]["free"], 0);
  EXPECT_LE(json["random_edges"]["free"], json["random_edges"]["edges"]);
  EXPECT_THAT(problem.out, HasSubstr("time goes to: "));
  write("alone.yaml",
        "format: corridor-problem-1\nrobot: arm.urdf\nworld: {}\n"
        "start: {shoulder: 0, elbow: 0}\ngoal: {shoulder: 2.8, elbow: 0.5}\n");
  EXPECT_THAT(run("inspect alone.yaml").out,
              HasSubstr("pairs tested: 0: NOTHING IS TESTED, every state is valid\n"));
  const Result robot = run("inspect arm.urdf");
  EXPECT_EQ(robot.status, 0) << robot.err;
  EXPECT_THAT(robot.out, HasSubstr("joint: \"elbow\": revolute, upper to lower, -2 to 2 rad\n"));
  EXPECT_THAT(robot.out, HasSubstr("link: \"lower\": box\n"));
  EXPECT_EQ(run("inspect robot.yaml").status, 0);
}

TEST_F(CommandLine, SameSeedSameFile) {
  EXPECT_EQ(run("solve problem.yaml --seed 5 -o a.yaml").status, 0);
  EXPECT_EQ(run("solve problem.yaml --seed 5 -o b.yaml").status, 0);
  EXPECT_EQ(run("solve problem.yaml --seed 6 -o c.yaml").status, 0);
  EXPECT_EQ(read("a.yaml"), read("b.yaml"));
  EXPECT_NE(read("a.yaml"), read("c.yaml"));
}

TEST_F(CommandLine, BadInputIsOneLineAndExit2) {
  const auto fault = [&](const std::string& arguments, const auto& line) {
    const Result result = run(arguments);
    EXPECT_EQ(result.status, 2) << arguments;
    EXPECT_THAT(result.err, line) << arguments;
    EXPECT_EQ(result.out, "") << arguments;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  };
  fault("solve none.yaml", StartsWith("none.yaml: "));
  fault("solve problem.yaml --planner RRTx -o s.yaml",
        StartsWith("--planner: unknown planner \"RRTx\""));
  fault("solve problem.yaml --set rnge=1",
        StartsWith("--set: RRTConnect has no parameter \"rnge\"; did you mean \"range\"?"));
  fault("solve problem.yaml --set range",
        testing::Eq("--set: key=value is needed, not \"range\"\n"));
  fault("solve problem.yaml --set range=long",
        testing::Eq("--set: RRTConnect's parameter range: \"long\" is not a number\n"));
  fault("solve problem.yaml --sampler max_clearence",
        testing::Eq(
            "--sampler: one of uniform, gaussian, obstacle_based, bridge_test, max_clearance is "
            "needed, not \"max_clearence\"; did you mean \"max_clearance\"?\n"));
  fault("solve problem.yaml problem.yaml -o s.yaml",
        testing::Eq("--output: names one file, but there are 2 problems\n"));
  fault("solve problem.yaml -o none/s.yaml", testing::Eq("--output: there is no folder none\n"));
  for (const char* file : {"problem.yaml", "./robot.yaml"})
    for (const char* option : {"--output", "--picture"})
      fault(std::string("solve problem.yaml ") + option + " " + file,
            testing::Eq(std::string(option) + ": " + file +
                        " belongs to the problem and would be overwritten; name another file\n"));
  fault("solve problem.yaml --picture .",
        testing::Eq("--picture: . is a folder; a file's name is needed\n"));
  fault("solve problem.yaml --edges discrete --resolution 1",
        StartsWith("--resolution: must be from 1e-9 to below 1, not 1\n"));
  write("fine.yaml", problem("-2, 0, 0", "checker: {edges: discrete, resolution: 1e-300}\n"));
  fault("solve fine.yaml",
        testing::Eq("fine.yaml:8: checker.resolution: must be from 1e-9 to below 1, not 1e-300\n"));
  fault("verify problem.yaml none.yaml", StartsWith("none.yaml: "));
  write("package.urdf",
        "<robot name=\"r\">\n<link name=\"a\"><collision><geometry><mesh "
        "filename=\"package://p/m.obj\"/></geometry></collision></link>\n</robot>\n");
  fault(
      "inspect package.urdf",
      testing::Eq("package.urdf:2: link \"a\": mesh \"package://p/m.obj\": p/m.obj is not a file, "
                  "and package \"p\" has no folder; add robot.yaml: packages: {p: FOLDER}\n"));
  fault("check problem.yaml --states .", testing::Eq(".: is a folder; a file is needed\n"));
  fault("check problem.yaml --states /dev/zero",
        testing::Eq("/dev/zero: is a device; an ordinary file is needed\n"));
  write("problem.yaml", problem("0.05, 0, 0"));
  fault("solve problem.yaml -o s.yaml",
        StartsWith("problem.yaml:5: start is in contact: \"cube\" (triangle "));
  write("problem.yaml", problem("9, 0, 0"));
  fault("solve problem.yaml -o s.yaml", StartsWith("problem.yaml:5: start"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "s.yaml"));
}

TEST_F(CommandLine, BadUsageIsExit2) {
  for (const char* arguments :
       {"", "sove problem.yaml", "solve", "solve problem.yaml --edges sampled",
        "solve problem.yaml --time -1", "solve problem.yaml --time nan",
        "solve problem.yaml --time inf", "solve problem.yaml --seed -1",
        "solve problem.yaml --no-such"})
    EXPECT_EQ(run(arguments).status, 2) << arguments;
}

TEST_F(CommandLine, BadUsageIsOneLine) {
  const auto said = [&](const std::string& arguments) { return run(arguments).err; };
  EXPECT_EQ(said(""), "A subcommand is required; see corridor --help\n");
  EXPECT_EQ(said("slove problem.yaml"),
            "unknown command \"slove\"; did you mean \"solve\"?; there are: solve, verify, "
            "view, benchmark, check, inspect, query\n");
  EXPECT_EQ(said("verify problem.yaml"), "SOLUTION is required; see corridor verify --help\n");
  for (const char* time : {"0", "-1", "nan", "inf", "20s"})
    EXPECT_EQ(said(std::string("solve problem.yaml --time ") + time),
              std::string("--time: a number of seconds above 0 is needed, not \"") + time +
                  "\"; see corridor solve --help\n");
  for (const char* seed : {"-1", "1.5", "abc", "18446744073709551616"})
    EXPECT_EQ(said(std::string("solve problem.yaml --seed ") + seed),
              std::string("--seed: a whole number from 0 to 2^64 - 1 is needed, not \"") + seed +
                  "\"; see corridor solve --help\n");
  EXPECT_EQ(run("solve problem.yaml --seed 0").status, 0);
}

/// CLI11's own messages name the option last, or not at all.
TEST_F(CommandLine, WordsThatNoCommandTakesAreTold) {
  const auto fault = [&](const std::string& arguments, const std::string& told) {
    expectFault(arguments,
                told + "; see corridor " + arguments.substr(0, arguments.find(' ')) + " --help");
  };
  fault("solve problem.yaml --stopp first", "unknown option \"--stopp\"; did you mean \"--stop\"?");
  fault("solve problem.yaml --tme=3", "unknown option \"--tme\"; did you mean \"--time\"?");
  fault("verify problem.yaml s.yaml more.yaml", "unexpected word \"more.yaml\"");
  fault("solve problem.yaml -- more.yaml", "unexpected word \"more.yaml\"");
  expectFault("--tme=3 solve problem.yaml",
              "unknown option \"--tme\"; did you mean \"--time\"?; see corridor solve --help");
  expectFault("more solve problem.yaml", "unexpected word \"more\"; see corridor solve --help");
  fault("solve problem.yaml --time 1 --time 2", "--time is given 2 times; once is enough");
  fault("solve problem.yaml -o a.yaml -o a.yaml", "--output is given 2 times; once is enough");
  fault("solve problem.yaml -o ''", "--output: is empty");
  fault("solve ''", "PROBLEM: is empty");
  for (const char* edges : {"certified", "adaptive"})
    expectFault(std::string("solve problem.yaml --resolution 0.1 --edges ") + edges,
                std::string("--resolution: needs --edges discrete, and edges are ") + edges);
  expectFault("inspect cube.obj --pairs", "--pairs: needs a problem, and cube.obj is a mesh");
  expectFault("inspect problem.yaml --self-intersections",
              "--self-intersections: needs a mesh, and problem.yaml is a problem");
  expectFault("inspect cube.obj --against cube.obj --self-intersections",
              "--self-intersections: can't be used with --against");
  write("crossed.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 1 1 -1\nv 1 1 1\nv 9 9 0\nf 1 2 3\nf 4 5 6\n");
  EXPECT_THAT(run("inspect crossed.obj --self-intersections").out,
              HasSubstr("self-intersections: 1, the first between triangles 0 and 1 (from 0)"));
  expectFault("inspect problem.yaml --unit mm",
              "--unit: needs a mesh, and problem.yaml is a problem");
  expectFault("inspect robot.yaml --up y", "--up: needs a mesh, and robot.yaml is a robot");
  expectFault("solve problem.yaml --set range=1 --set range=2", "--set: \"range\" is set twice");
  EXPECT_EQ(run("solve problem.yaml --quiet --quiet").status, 0);
}

/// Results lost on a full disk must not end with exit status 0.
TEST_F(CommandLine, AnOutputThatCannotBeWrittenIsTold) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
  write("poses.txt", "1 0 0 0 1 0 0 0 1 0 0 0\n");
  for (const char* command : {"solve problem.yaml", "check problem.yaml --json", "inspect cube.obj",
                              "query cube.obj wall.obj --poses poses.txt",
                              "benchmark problem.yaml --variants certified --runs 1"}) {
    const Result result = run(command + std::string(" >/dev/full 2>told.txt; exit $?;"));
    EXPECT_EQ(result.status, 2) << command;
    EXPECT_THAT(read("told.txt"),
                testing::EndsWith("standard output: can't be written, or not all of it\n"))
        << command;
  }
  EXPECT_EQ(run("solve problem.yaml --quiet >/dev/full; exit $?;").status, 0);
}

/// A limit on files' sizes acts like a full disk; SIGXFSZ must not end the program.
TEST_F(CommandLine, AFileThatMayNotGrowIsToldAndNotLeftInHalf) {
  const Result whole = run("solve problem.yaml --seed 1 --picture p.svg");
  ASSERT_EQ(whole.status, 0) << whole.err;
  ASSERT_GT(std::filesystem::file_size(folder_ / "p.svg"), 1024u);
  std::filesystem::remove(folder_ / "p.svg");
  const Result cut = run("solve problem.yaml --seed 1 --picture p.svg", "ulimit -f 2 && ");
  EXPECT_EQ(cut.status, 2);
  EXPECT_EQ(cut.err,
            "p.svg: can't be written: File too large; raise the limit on the size of files (ulimit "
            "-f)\n");
  for (const auto& entry : std::filesystem::directory_iterator(folder_))
    EXPECT_EQ(entry.path().string().find("p.svg"), std::string::npos) << entry.path();
}

TEST_F(CommandLine, HelpTellsExamplesAndExitStatus) {
  for (const char* command : {"solve", "verify", "check", "inspect", "query", "benchmark"}) {
    const Result help = run(std::string(command) + " --help");
    EXPECT_EQ(help.status, 0);
    EXPECT_THAT(help.out, HasSubstr(std::string("Example: corridor ") + command));
    EXPECT_THAT(help.out, HasSubstr("Exit status: 0 done; 1 no"));
  }
}

TEST_F(CommandLine, NothingFoundIsExit1AndWritesNothing) {
  write("wall.obj", "v 0 -5 -5\nv 0 5 -5\nv 0 5 5\nv 0 -5 5\nf 1 2 3\nf 1 3 4\n");
  const Result result = run("solve problem.yaml --time 0.3 -o s.yaml");
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.out, HasSubstr("why: "));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "s.yaml"));
}

TEST_F(CommandLine, ManyProblemsExitWithTheWorst) {
  EXPECT_EQ(run("solve problem.yaml problem.yaml --quiet").status, 0);
  const Result result = run("solve problem.yaml none.yaml problem.yaml");
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.err, StartsWith("none.yaml: "));
  EXPECT_THAT(result.out, HasSubstr("result: solved"));
  EXPECT_EQ(run("solve problem.yaml --quiet").out, "");
}

TEST_F(CommandLine, InterruptedIsExit130) {
  write("wall.obj", "v 0 -5 -5\nv 0 5 -5\nv 0 5 5\nv 0 -5 5\nf 1 2 3\nf 1 3 4\n");
  const Result result =
      run("solve problem.yaml --time 60 -o s.yaml & pid=$!; sleep 0.5; kill -INT $pid; wait $pid; "
          "exit $?;");
  EXPECT_EQ(result.status, 130);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "s.yaml"));
}

}  // namespace
