// Inputs as people, drivers and other programs write them: files of other encodings and names, and
// outputs at unusual places.
#include <filesystem>
#include <fstream>
#include <string>
#include <sys/stat.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/planner/app/program_fixtures.h"

namespace corridor::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

class FieldInputs : public ArmTest {
 protected:
  static std::string robotNamed(const std::string& joint, const std::string& encoding = "") {
    return (encoding.empty() ? "" : "<?xml version='1.0' encoding='" + encoding + "'?>\n") +
           "<robot name='r'><link name='a'/><link name='b'><collision><geometry><sphere "
           "radius='0.1'/></geometry></collision></link><joint name=\"" +
           joint +
           "\" type='revolute'><parent link='a'/><child link='b'/><limit lower='-1' upper='1' "
           "effort='1' velocity='1'/></joint></robot>\n";
  }
  /// Requires that the output of --json is JSON, whatever the status.
  void expectJson(const std::string& arguments, int status) {
    const Result result = run(arguments);
    EXPECT_EQ(result.status, status) << arguments << "\n" << result.err;
    if (!result.out.empty()) {
      EXPECT_TRUE(nlohmann::json::accept(result.out)) << arguments;
    }
  }
};

TEST_F(FieldInputs, TextThatIsNotUtf8) {
  write("latin1.urdf", robotNamed("T\xFCr", "ISO-8859-1"));
  write("undeclared.urdf", robotNamed("T\xFCr"));
  write("japanese.urdf", robotNamed("\x8A\xD6\x90\xDF", "Shift_JIS"));
  write("T\xFCr.urdf", robotNamed("door"));
  write("T\xFCr.yaml",
        "format: corridor-problem-1\nrobot: \"arm.urdf\"\nworld: {}\nname: T\xFCr\n");
  for (const std::string file : {"latin1.urdf", "japanese.urdf", "T\xFCr.urdf"})
    expectJson("inspect --json '" + file + "'", 0);
  for (const std::string file : {"undeclared.urdf", "T\xFCr.yaml"})
    expectJson("inspect --json '" + file + "'", 2);
  EXPECT_THAT(run("inspect 'T\xFCr.yaml'").err,
              HasSubstr("T?r.yaml:4: is not in UTF-8 (byte 0xFC)"));
  // What `new problem` writes, `check` reads.
  for (const std::string file : {"latin1.urdf", "japanese.urdf"}) {
    ASSERT_EQ(run("new problem " + file + " -o new.yaml --force").status, 0);
    EXPECT_EQ(run("check new.yaml").status, 0) << file;
  }
  EXPECT_THAT(run("new problem 'T\xFCr.urdf' -o new.yaml --force").err,
              HasSubstr("this name is not in UTF-8, and YAML has no other; rename the file"));
}

TEST_F(FieldInputs, NamesOfJoints) {
  for (const std::string name : {"Joint 1", "a,b", "a # b", "time", "from", "within", "a: b", "-1",
                                 "yes", "(deg)", "it's", "velocity/x", "\u30a2", "a_velocity"}) {
    write("named.urdf", robotNamed(name));
    ASSERT_EQ(run("new problem named.urdf -o named.yaml --force").status, 0) << name;
    EXPECT_EQ(run("check named.yaml").status, 0) << name << "\n" << read("named.yaml");
    const Result solved = run("solve named.yaml --trajectory t.csv -o s.yaml");
    EXPECT_EQ(solved.status, 0) << name << solved.out << solved.err;
    EXPECT_EQ(run("verify named.yaml t.csv").status, 0) << name;
    EXPECT_EQ(run("verify named.yaml s.yaml").status, 0) << name;
  }
}

TEST_F(FieldInputs, FilesByAnotherName) {
  for (const std::string name : {"ARM.URDF", "arm.xml", "arm", "arm.Urdf"}) {
    write(name, read("arm.urdf"));
    EXPECT_THAT(run("inspect " + name).out, HasSubstr("joint: \"elbow\": revolute")) << name;
    write("p.yaml",
          "format: corridor-problem-1\nrobot: " + name +
              "\nworld: {}\nstart: {shoulder: 0, elbow: 0}\ngoal: {shoulder: 1, elbow: 0}\n");
    EXPECT_EQ(run("check p.yaml").status, 0) << name;
  }
  for (const auto& [name, text, what] :
       std::vector<std::tuple<std::string, std::string, std::string>>{
           {"page.stl", "<!DOCTYPE html>\n<html><body>404</body></html>",
            "is a web page; a mesh file"},
           {"step.stl", "ISO-10303-21;\nHEADER;\n", "is a STEP file; a mesh file"},
           {"zip.obj", "PK\x03\x04xxxxxxxxxxxxxxxxx", "is a ZIP archive; a mesh file"},
           {"gz.ply", "\x1F\x8B\x08xxxxxxxxxxxxxxx", "is a gzip archive; a mesh file"},
           {"page.urdf", "\n<html>\n", "is a web page; a robot (URDF)"},
           {"page.yaml", "<!doctype HTML>\n", "is a web page; a problem"},
           {"text.stl", "ply\nformat ascii 1.0\n" + std::string(100, 'c') + "\n",
            "is no STL file: it begins with the text \"ply\""},
           {"utf16.urdf", "\xFF\xFE<\x01", "is text in UTF-16; save it in UTF-8"},
           {"lfs.stl", "version https://git-lfs.github.com/spec/v1\noid sha256:0\n",
            "git lfs pull"}}) {
    write(name, text);
    const Result result = run("inspect " + name);
    EXPECT_EQ(result.status, 2) << name;
    EXPECT_THAT(result.err, HasSubstr(what)) << name;
  }
  for (const auto& [name, text] : std::vector<std::pair<std::string, std::string>>{
           {"b.stl",
            "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
            "0\nendloop\nendfacet\nendsolid a\n"},
           {"b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
           {"b.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
           {"b.ply",
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float "
            "y\nproperty float z\nelement face 1\nproperty list uchar int "
            "vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"}}) {
    write(name, "\xEF\xBB\xBF" + text);
    EXPECT_THAT(run("inspect " + name).out, HasSubstr("triangles: 1\n")) << name;
  }
}

/// Fingers of a robot without groups move at random: a note says so, unless the user has chosen.
TEST_F(FieldInputs, JointsThatNeedNotMove) {
  write("two.urdf",
        "<robot name='r'><link name='a'/><link name='b'><collision><geometry><sphere "
        "radius='0.1'/></geometry></collision></link><link name='f'><collision><origin xyz='1 0 "
        "0'/><geometry><sphere radius='0.1'/></geometry></collision></link><joint name='arm' "
        "type='revolute'><parent link='a'/><child link='b'/><axis xyz='0 0 1'/><limit lower='-3' "
        "upper='3' effort='1' velocity='1'/></joint><joint name='finger' type='revolute'><parent "
        "link='b'/><child link='f'/><axis xyz='0 1 0'/><limit lower='-1' upper='1' effort='1' "
        "velocity='1'/></joint></robot>\n");
  const auto problem = [&](const std::string& robot, const std::string& goal) {
    write("p.yaml", "format: corridor-problem-1\nrobot: " + robot +
                        "\nworld: {post: {box: [0.2, 0.2, 1], at: [1, 0, 0]}}\n"
                        "start: {arm: -1.5, finger: 0.1}\ngoal: " +
                        goal + "\n");
    const Result result = run("solve p.yaml");
    EXPECT_EQ(result.status, 0) << result.err << result.out;
    return result.out;
  };
  const std::string note = "note: the path moves finger, although start and goal have the same";
  EXPECT_THAT(problem("two.urdf", "{arm: 1.5, finger: 0.1}"), HasSubstr(note));
  EXPECT_THAT(problem("two.urdf", "{arm: 1.5, finger: 0.2}"), Not(HasSubstr(note)));
  EXPECT_THAT(problem("two.urdf", "[{arm: 1.5, finger: 0.1}, {arm: 1.4, finger: 0.2}]"),
              Not(HasSubstr(note)));
  write("held.yaml", "format: corridor-robot-1\nurdf: two.urdf\nhold: {finger: 0.1}\n");
  EXPECT_THAT(problem("held.yaml", "{arm: -0.8, finger: 0.1}"), Not(HasSubstr(note)));
}

TEST_F(FieldInputs, WhatOtherProgramsHave) {
  write("p.yaml", read("arm.yaml") + "attached: {cup: {sphere: 0.1}}\n");
  EXPECT_THAT(
      run("check p.yaml").err,
      HasSubstr("p.yaml:7: \"attached\" is not supported yet; add the object to the robot's "
                "URDF, as a link with a fixed joint"));
}

TEST_F(FieldInputs, OutputsAtUnusualPlaces) {
  // A symbolic link stays one; the file behind it is written, and keeps its mode.
  write("behind.yaml", "old\n");
  ::chmod((folder_ / "behind.yaml").c_str(), 0640);
  fs::create_symlink("behind.yaml", folder_ / "link.yaml");
  fs::create_symlink("new.yaml", folder_ / "dangling.yaml");
  for (const std::string name : {"link.yaml", "dangling.yaml"}) {
    EXPECT_EQ(run("solve arm.yaml -o " + name).status, 0);
    EXPECT_TRUE(fs::is_symlink(folder_ / name));
  }
  EXPECT_THAT(read("behind.yaml"), HasSubstr("format: corridor-solution"));
  EXPECT_EQ(fs::status(folder_ / "behind.yaml").permissions(), fs::perms(0640));
  EXPECT_THAT(read("new.yaml"), HasSubstr("format: corridor-solution"));
  const std::string longest = std::string(250, 'n') + ".yaml";
  EXPECT_EQ(run("solve arm.yaml -o " + longest).status, 0) << "255 bytes";
  EXPECT_EQ(run("verify arm.yaml " + longest).status, 0);
  // What other programs have written to the standard output stays.
  write("log.txt", "before\n");
  const std::string program = "cd '" + folder_.string() + "' && '" CORRIDOR_PROGRAM "' ";
  EXPECT_EQ(std::system((program + "solve arm.yaml --quiet -o /dev/stdout >> log.txt").c_str()), 0);
  EXPECT_THAT(read("log.txt"), testing::StartsWith("before\n"));
  EXPECT_THAT(read("log.txt"), HasSubstr("format: corridor-solution"));
  EXPECT_EQ(std::system((program + "solve arm.yaml -o /dev/stdout > all.txt").c_str()), 0);
  EXPECT_THAT(read("all.txt"), testing::StartsWith("# "));
  EXPECT_THAT(read("all.txt"), HasSubstr("\nresult: solved"));
  EXPECT_EQ(
      std::system((program + "solve arm.yaml --quiet -o /dev/stdout | cat > piped.txt").c_str()),
      0);
  EXPECT_THAT(read("piped.txt"), HasSubstr("format: corridor-solution"));
  fs::create_symlink("b.yaml", folder_ / "a.yaml");
  fs::create_symlink("a.yaml", folder_ / "b.yaml");
  EXPECT_EQ(run("solve arm.yaml -o a.yaml").status, 2);
  EXPECT_TRUE(fs::is_symlink(folder_ / "a.yaml"));
  // Nothing else is left in the folder.
  for (const auto& entry : fs::directory_iterator(folder_))
    EXPECT_THAT(entry.path().filename().string(), Not(HasSubstr(".tmp")));
}

TEST_F(FieldInputs, PipesAndDeletedFolders) {
  ASSERT_EQ(run("solve arm.yaml -o s.yaml --trajectory t.csv").status, 0);
  for (const std::string file : {"s.yaml", "t.csv"}) {
    const Result piped = run("verify arm.yaml fifo", "mkfifo fifo; (cat " + file + " > fifo &) ; ");
    EXPECT_EQ(piped.status, 0) << piped.err;
    EXPECT_THAT(piped.out, HasSubstr("verdict: proved")) << file;
    fs::remove(folder_ / "fifo");
  }
  const std::string here = folder_.string();
  const int gone = std::system(("mkdir " + here + "/d && cd " + here + "/d && rmdir " + here +
                                "/d && '" CORRIDOR_PROGRAM "' inspect arm.urdf >" + here +
                                "/out.txt 2>" + here + "/err.txt")
                                   .c_str());
  EXPECT_EQ(WEXITSTATUS(gone), 2) << read("err.txt");
}

/// What a stranger's inputs found: values that were dropped in silence, and advice that failed.
TEST_F(FieldInputs, LimitsAndWeights) {
  const auto robot = [&](const std::string& more) {
    return "<robot name='r'><link name='a'/><link name='b'><collision><geometry><sphere "
           "radius='0.1'/></geometry></collision></link><link name='c'/><joint name='eq' "
           "type='prismatic'><parent link='b'/><child link='c'/><limit lower='0.3' upper='0.3' "
           "effort='1' velocity='1'/></joint><joint name='turn' type='continuous'><parent "
           "link='a'/><child link='b'/>" +
           more + "</joint></robot>\n";
  };
  write("soft.urdf", robot("<safety_controller k_velocity='1' soft_lower_limit='-1' "
                           "soft_upper_limit='1'/>"));
  EXPECT_THAT(run("inspect soft.urdf").out,
              HasSubstr("is continuous, so its soft limits are not used"));
  write("limit.urdf", robot("<limit lower='1' upper='-1' effort='1' velocity='1'/>"));
  EXPECT_THAT(run("inspect limit.urdf").out, HasSubstr("<limit> are not used"));
  write("weights.yaml",
        "format: corridor-robot-1\nurdf: limit.urdf\nweights: {joints: {eq: 2, turn: 3}}\n");
  EXPECT_THAT(run("inspect weights.yaml").out, HasSubstr("weights of eq are not used"));
  write("line.urdf", robotNamed("a&#10;b"));
  ASSERT_EQ(run("new problem line.urdf -o line.yaml").status, 0);
  EXPECT_THAT(run("solve line.yaml --trajectory t.csv").err,
              HasSubstr("has a line end, which CSV can't hold"));
  EXPECT_EQ(run("solve line.yaml --trajectory t.yaml").status, 0);
  write("p.yaml",
        "format: corridor-problem-1\nrobot: limit.urdf\nworld: {}\nstart: {turn: 0, eq: 0}\n"
        "goal: {turn: 1}\n");
  EXPECT_THAT(run("check p.yaml").err,
              HasSubstr("start.eq: its limits are equal: 0.3 is its only value"));
  write("p.yaml",
        "format: corridor-problem-1\nrobot: limit.urdf\nworld: {}\nstart: {turn: 0}\n"
        "goal: {turn: 1}\nlimits: {file: jl.yaml}\n");
  write("states.txt", "0\n");
  EXPECT_THAT(run("check p.yaml --states states.txt").err, HasSubstr("<limit> are not used"));
  write("rows.csv", "time,turn,eq\n0,0,0\n1,1,0\n");
  EXPECT_THAT(run("verify p.yaml rows.csv").err, Not(HasSubstr("hold")));
  // Start and goal on both sides of π, nearly equal: rows are not taken modulo turns.
  write("pi.yaml",
        "format: corridor-problem-1\nrobot: limit.urdf\nworld: {}\n"
        "start: {turn: 3.1415926535}\ngoal: {turn: -3.1415926535}\n");
  EXPECT_EQ(run("solve pi.yaml --trajectory pi.csv").status, 0);
  EXPECT_EQ(run("verify pi.yaml pi.csv").status, 0);
  // The tags of ROS.
  write("jl.yaml",
        "joint_limits:\n  turn: {has_velocity_limits: true, max_velocity: !degrees 90.0}\n");
  const Result solved = run("solve p.yaml --trajectory t.csv --json");
  ASSERT_EQ(solved.status, 0) << solved.err;
  const double seconds =
      nlohmann::json::parse(solved.out)["problems"][0]["trajectory"]["duration_s"];
  EXPECT_GT(seconds, 1 / 1.5708) << "1 rad at 90° per second";
  EXPECT_LT(seconds, 10);
}

/// The inputs that are kept beside the project (CORRIDOR_DATA/reports), with their right answers.
TEST_F(FieldInputs, Reports) {
  const char* const data = std::getenv("CORRIDOR_DATA");
  if (!data) GTEST_SKIP() << "set CORRIDOR_DATA to a folder with reports/";
  const std::string reports = std::string(data) + "/reports/";
  const auto text = [&](const std::string& arguments, int status) {
    const Result result = run(arguments);
    EXPECT_EQ(result.status, status) << arguments << "\n" << result.out << result.err;
    return result.out + result.err;
  };
  EXPECT_THAT(text("check " + reports + "a08/cube.yaml", 0), HasSubstr("thing in wrist"));
  for (const std::string name : {"d09/inertialnomass.urdf", "d09/safety.urdf", "d13/v1.1.urdf",
                                 "d21/arm.URDF", "d23/bom.stl", "d23/cr.ply"})
    text("inspect " + reports + name, 0);
  EXPECT_THAT(text("inspect " + reports + "d09/colinvisual.urdf", 0),
              HasSubstr("colinvisual.urdf:4: link \"a\": the <collision> in <visual> is not read"));
  EXPECT_THAT(text("check " + reports + "d10/cont_limits.yaml", 0),
              HasSubstr("is continuous, so lower and upper of its <limit> are not used"));
  EXPECT_THAT(text("check " + reports + "d16/lshape.yaml --states " + reports + "d16/lpts.txt", 1),
              HasSubstr("0,1,\n1,0,ball~plate\n2,0,ball~plate\n3,0,ball~plate\n4,1,\n"));
  EXPECT_THAT(text("check " + reports + "d19/passive.yaml", 2),
              HasSubstr("has no value for j1, j3, j4"));
  for (const std::string name : {"d20/echo_ros2_operation.yaml", "d20/echo_octomap_frame.yaml"})
    EXPECT_THAT(text("check " + reports + name, 1), HasSubstr("\"l1\" and \"crate\" touch"));
  EXPECT_THAT(text("inspect " + reports + "d21/page.stl", 2), HasSubstr("is a web page"));
  text("solve " + reports + "d22/blank.yaml --trajectory x.csv", 0);
  text("verify " + reports + "d22/blank.yaml x.csv", 0);
  text("check " + reports + "d22/from.yaml", 0);
  expectJson("inspect --json " + reports + "d24/latin1.urdf", 0);
  text("solve " + reports + "e02/ulp.yaml --trajectory y.csv", 0);
  text("check " + reports + "e03/fixedfree.yaml", 0);
  EXPECT_THAT(text("solve " + reports + "f06/soft.yaml --trajectory z.csv", 0),
              HasSubstr("soft limits of j1, j2 are not used"));
  EXPECT_THAT(text("verify " + reports + "s1/p.yaml " + reports + "s1/heldvel.csv", 2),
              HasSubstr("\"j2\" is held at 0"));
}

}  // namespace
}  // namespace corridor::test
