// Tests of the program `corridor inspect`: its reports on meshes, robots and problems, and the file
// that it selects in a folder.
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/planner/app/program_fixtures.h"

namespace {

using testing::HasSubstr;
using testing::StartsWith;

using InspectCommand = corridor::test::ProgramTest;
using InspectProblem = corridor::test::ArmTest;
using InspectCube = corridor::test::CubeTest;

/// The range of a joint that mimics another joint follows from the other joint's range, even if it
/// exceeds the limits of the mimicking joint.
TEST_F(InspectCommand, ReportsTheReachWithMimicJoints) {
  const auto joint = [](const std::string& name, const std::string& parent,
                        const std::string& more) {
    return "<link name='" + name + "'/><joint name='" + name + "' type='prismatic'><parent link='" +
           parent + "'/><child link='" + name + "'/><origin xyz='1 0 0'/>" + more + "</joint>\n";
  };
  const std::string free =
      "<limit effort='1' velocity='1'/>";  // without limits, the joint's own range is 0 to 0
  // `first` mimics `last`, which comes after it in the file. The range of `first` is −2·[−0.5,
  // 0.25] + 0.5.
  write("slides.urdf",
        "<robot name='slides'><link name='base'/>\n" +
            joint("first", "base", free + "<mimic joint='last' multiplier='-2' offset='0.5'/>") +
            joint("last", "first",
                  "<limit lower='-0.5' upper='0.25' effort='1' "
                  "velocity='1'/>") +
            joint("still", "last", free + "<mimic joint='last' multiplier='0' offset='-0.125'/>") +
            joint("stiller", "still", free + "<mimic joint='wheel' multiplier='0' offset='2'/>") +
            "<link name='wheel'/><joint name='wheel' type='continuous'><parent link='stiller'/>"
            "<child link='wheel'/></joint></robot>");
  const Result result = run("inspect slides.urdf --json");
  ASSERT_EQ(result.status, 0) << result.err;
  const auto links = nlohmann::json::parse(result.out)["links"];
  ASSERT_EQ(links.size(), 6u);
  EXPECT_EQ(links[1]["reach_m"], 1 + 1.5);
  EXPECT_EQ(links[2]["reach_m"], 1 + 1.5 + 1 + 0.5);
  EXPECT_EQ(links[3]["reach_m"], 1 + 1.5 + 1 + 0.5 + 1 + 0.125);
  EXPECT_EQ(links[4]["reach_m"],
            1 + 1.5 + 1 + 0.5 + 1 + 0.125 + 1 +
                2);  // the multiplier 0 counts as 0, although the leader has no limit
  EXPECT_EQ(links[5]["reach_m"], links[4]["reach_m"]);
}

/// A robot that cannot move can't be planned for, but `inspect` describes it.
TEST_F(InspectCommand, DescribesARobotThatCannotMove) {
  write("still.urdf",
        "<robot name='still'><link name='a'/>\n<link name='b'/>\n<joint name='j' "
        "type='revolute'><parent link='a'/><child link='b'/><limit lower='0' upper='0' effort='1' "
        "velocity='1'/></joint></robot>");
  const std::string why = "has no joint that can be planned for: j: lower = upper = 0";
  write("still.yaml", "format: corridor-robot-1\nurdf: still.urdf\n");
  for (const std::string file : {"still.urdf", "still.yaml"}) {
    const Result result = run("inspect " + file);
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_THAT(result.out, HasSubstr("joint: \"j\": revolute, a to b, 0 to 0 rad\n"));
    EXPECT_THAT(result.out,
                HasSubstr("note: still.urdf: " + why + "; problems refuse this robot\n"));
    EXPECT_EQ(run("pose " + file).status, 0);
  }
  expectFault("new problem still.urdf", "still.urdf: " + why);
  expectFault("new problem still.yaml", "still.yaml:2: urdf: " + why);
}

/// What a mesh file says beyond its triangles is noted wherever the robot is described.
TEST_F(InspectCommand, NotesOnTheMeshesOfRobots) {
  write("lined.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nl 1 2\n");
  write("lined.urdf",
        "<robot name='lined'><link name='a'/><link name='b'><collision><geometry>"
        "<mesh filename='file://" +
            (folder_ / "lined.obj").string() +
            "'/></geometry></collision></link><joint name='j' type='continuous'><parent link='a'/>"
            "<child link='b'/></joint></robot>");
  const Result text = run("inspect lined.urdf");
  EXPECT_THAT(text.out, testing::ContainsRegex("\nnote: .*lined.obj")) << text.err;
  const auto json = nlohmann::json::parse(run("inspect lined.urdf --json").out);
  EXPECT_THAT(json["notes"].dump(), HasSubstr("lined.obj"));
  ASSERT_EQ(run("new robot lined.urdf -o r.yaml").status, 0);
  EXPECT_THAT(read("r.yaml"), testing::ContainsRegex("\n# Note: .*lined.obj"));
}

TEST_F(InspectProblem, ReportsPosesOfObstaclesAndHeldJoints) {
  write(
      "robot.yaml",
      "format: corridor-robot-1\nurdf: arm.urdf\njoints: [shoulder]\nstates: {home: {shoulder: 0, "
      "elbow: 0.5}}\n");
  const auto problem = [&](const std::string& start) {
    write("held.yaml",
          "format: corridor-problem-1\nrobot: robot.yaml\nworld:\n  post: {box: [1, 1, 1], at: [5, "
          "6, "
          "7], rpy_deg: [0, 0, 90]}\nstart: " +
              start + "\ngoal: {shoulder: 1}\n");
    return run("inspect held.yaml").out;
  };
  EXPECT_THAT(problem("{shoulder: 0}"),
              HasSubstr("world: \"post\": box, at [5, 6, 7], rpy_deg [0, 0, 90]\n"));
  EXPECT_THAT(problem("{shoulder: 0}"), HasSubstr("held: \"elbow\": 0 rad (default)\n"));
  EXPECT_THAT(problem("home"), HasSubstr("held: \"elbow\": 0.5 rad (start: home)\n"));
  const auto json = nlohmann::json::parse(run("inspect held.yaml --json").out);
  EXPECT_EQ(json["held"][0]["name"], "elbow");
  EXPECT_EQ(json["held"][0]["value"], 0.5);
  EXPECT_EQ(json["held"][0]["from"], "start: home");
  EXPECT_EQ(json["bodies"].back()["shapes"][0]["position"], nlohmann::json({5, 6, 7}));
  for (const std::string hold : {"{elbow: 0.25}", "home"}) {
    write("robot.yaml",
          "format: corridor-robot-1\nurdf: arm.urdf\njoints: [shoulder]\nstates: {home: {shoulder: "
          "0, "
          "elbow: 0.5}}\nhold: " +
              hold + "\n");
    EXPECT_THAT(problem("{shoulder: 0}"),
                HasSubstr(hold == "home" ? "held: \"elbow\": 0.5 rad (hold: home)\n"
                                         : "held: \"elbow\": 0.25 rad (hold)\n"));
  }
}

TEST_F(InspectCommand, SelectsTheFileOfAFolder) {
  const std::string arm6 = CORRIDOR_SOURCE_DIR "/robots/arm6";
  const Result named = run("inspect " + arm6 + "/robot.yaml"), found = run("inspect " + arm6);
  EXPECT_EQ(named.status, 0) << named.err;
  EXPECT_THAT(named.out, HasSubstr("robot: " + arm6 + "/robot.yaml\n"));
  EXPECT_EQ(found.out, named.out);
  expectFault("inspect " + arm6 + " --pairs",
              "--pairs: needs a problem, and " + arm6 + "/robot.yaml is a robot");
  // If a folder has both a problem and a robot, the problem is inspected, as by other commands.
  write("robot.yaml",
        "format: corridor-robot-1\nname: cube\nrigid: SE2\nshapes: [{box: [0.2, 0.2, 0.2]}]\n");
  write("problem.yaml",
        "format: corridor-problem-1\nrobot: robot.yaml\nworld: {wall: {box: [0.01, 6, 1]}}\nstart: "
        "{at: [-2, 0]}\n"
        "goal: {at: [2, 0]}\nbounds: {at: [[-4, -4], [4, 4]]}\n");
  EXPECT_THAT(run("inspect .").out, StartsWith("problem: ."));
  const auto in = [&](const std::string& folder, const std::string& name) {
    std::filesystem::create_directory(folder_ / folder);
    std::filesystem::copy(CORRIDOR_SOURCE_DIR "/robots/gantry/gantry.urdf",
                          folder_ / folder / name);
  };
  in("one", "gantry.urdf");
  EXPECT_THAT(run("inspect one").out, StartsWith("robot: one/gantry.urdf\n"));
  in("one", "leg.urdf");
  expectFault("inspect one",
              "one: no problem.yaml or robot.yaml in this folder, and several URDFs: name one of "
              "one/gantry.urdf, one/leg.urdf");
  std::filesystem::create_directory(folder_ / "none");
  expectFault("inspect none", "none: no problem.yaml, robot.yaml or URDF in this folder");
}

TEST_F(InspectCommand, ReportsWhyAMeshIsNotWatertight) {
  // A tetrahedron with one triangle of the wrong orientation. One corner is the upper end of the
  // bounds, and has coordinates of -0.
  write("turned.obj",
        "v -0 -0 -0\nv -1 0 0\nv 0 -1 0\nv 0 0 -1\nf 1 2 3\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  const Result text = run("inspect turned.obj");
  EXPECT_EQ(text.status, 0) << text.err;
  const std::string why = "its triangles do not face the same way at 3 of its edges";
  EXPECT_THAT(text.out, HasSubstr("watertight: no: " + why + "\n"));
  EXPECT_THAT(text.out, HasSubstr("boundary edges: 0\nnon-manifold edges: 0\nturned edges: 3\n"));
  EXPECT_THAT(text.out, HasSubstr("bounds: [-1, -1, -1] to [0, 0, 0] m\n"));
  const Result json = run("inspect turned.obj --json");
  EXPECT_EQ(json.out.find("-0.0"), std::string::npos) << json.out;
  const auto plain = nlohmann::json::parse(json.out);
  EXPECT_EQ(plain["format"], "corridor-inspect-mesh-2");
  EXPECT_EQ(plain["unit"], nullptr);
  EXPECT_EQ(plain["up"], nullptr);
  EXPECT_EQ(plain["mesh"]["watertight"], false);
  EXPECT_EQ(plain["mesh"]["why_not_watertight"], why);
  EXPECT_EQ(plain["mesh"]["turned_edges"], 3);
  const auto asked = nlohmann::json::parse(run("inspect turned.obj --json --unit mm --up y").out);
  EXPECT_EQ(asked["unit"], "mm");
  EXPECT_EQ(asked["up"], "y");
  EXPECT_EQ(asked["mesh"]["unit_rule"], "0.001 m per unit, as requested");
  EXPECT_EQ(asked["mesh"]["up_rule"], "y is up, as requested: rotated by (x, y, z) -> (x, -z, y)");
  write("closed.obj",
        "v 0 0 0\nv -1 0 0\nv 0 -1 0\nv 0 0 -1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  const auto closed = nlohmann::json::parse(run("inspect closed.obj --json").out)["mesh"];
  EXPECT_EQ(closed["watertight"], true);
  EXPECT_FALSE(closed.contains("why_not_watertight"));
}

TEST_F(InspectProblem, ReportsPairsAndRobots) {
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

TEST_F(InspectCube, BadInputIsOneLineAndExit2) {
  write("package.urdf",
        "<robot name=\"r\">\n<link name=\"a\"><collision><geometry><mesh "
        "filename=\"package://p/m.obj\"/></geometry></collision></link>\n</robot>\n");
  expectFault(
      "inspect package.urdf",
      "package.urdf:2: link \"a\": mesh \"package://p/m.obj\": p/m.obj is not a file, "
      "and no folder of package \"p\" was found; add packages: {p: FOLDER} to robot.yaml, or set "
      "ROS_PACKAGE_PATH or AMENT_PREFIX_PATH");
  write("cube.srdf", "<robot name=\"cube\"/>");
  expectFault("inspect cube.srdf",
              "cube.srdf: is an SRDF, which only adds to a URDF; name the URDF, or a robot.yaml "
              "with the keys urdf and srdf");
  expectFault("inspect cube.obj --pairs", "--pairs: needs a problem, and cube.obj is a mesh");
  expectFault("inspect problem.yaml --self-intersections",
              "--self-intersections: needs a mesh, and problem.yaml is a problem");
  expectFault("inspect cube.obj --against cube.obj --self-intersections",
              "--self-intersections: can't be used with --against");
  write("crossed.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 1 1 -1\nv 1 1 1\nv 9 9 0\nf 1 2 3\nf 4 5 6\n");
  EXPECT_THAT(
      run("inspect crossed.obj --self-intersections").out,
      HasSubstr("self-intersections: 1, the first between triangles 0 and 1 (counted from 0)"));
  expectFault("inspect problem.yaml --unit mm",
              "--unit: needs a mesh, and problem.yaml is a problem");
  expectFault("inspect robot.yaml --up y", "--up: needs a mesh, and robot.yaml is a robot");
}

}  // namespace
