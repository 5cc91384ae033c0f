// Tests of the program `corridor new`.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/planner/app/program_fixtures.h"

namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

/// A robot whose arm has two joints and the ball `hand` at its end. Three balls are fixed to the
/// base:
/// - far is never near the hand;
/// - inner is in contact with the hand in every state, by design;
/// - side is in contact with the hand in some states.
class NewCommand : public corridor::test::ArmTest {
 protected:
  NewCommand() {
    const auto ball = [](const std::string& name, const std::string& at, double radius) {
      return "<link name=\"" + name + "\"><collision><origin xyz=\"" + at +
             "\"/><geometry><sphere radius=\"" + std::to_string(radius) +
             "\"/></geometry></collision></link>\n";
    };
    const auto joint = [](const std::string& name, const std::string& parent,
                          const std::string& child, const std::string& at, double limit) {
      return "<joint name=\"" + name + "\" type=\"revolute\"><parent link=\"" + parent +
             "\"/><child link=\"" + child + "\"/><origin xyz=\"" + at +
             "\"/><axis xyz=\"0 0 1\"/><limit lower=\"-" + std::to_string(limit) + "\" upper=\"" +
             std::to_string(limit) + "\" effort=\"1\" velocity=\"1\"/></joint>\n";
    };
    const auto fixed = [](const std::string& child) {
      return "<joint name=\"to " + child +
             "\" type=\"fixed\"><parent link=\"base\"/><child link=\"" + child + "\"/></joint>\n";
    };
    write("reach.urdf",
          "<robot name=\"reach\">\n<link name=\"base\"/>\n<link name=\"upper\"/>\n"
          "<link name=\"skin\"><visual><geometry><sphere "
          "radius=\"1\"/></geometry></visual></link>\n" +
              ball("far", "-3 0 0", 0.5) + ball("inner", "1 0 0", 1.05) +
              ball("side", "1.9 0.5 0", 0.1) + ball("hand", "0.9 0 0", 0.2) + fixed("far") +
              fixed("inner") + fixed("side") + fixed("skin") +
              joint("shoulder", "base", "upper", "0 0 0", 0.4) +
              joint("elbow", "upper", "hand", "1 0 0", 0.2) + "</robot>\n");
    write(
        "reach.srdf",
        "<robot name=\"reach\">\n<group name=\"arm\"><joint name=\"shoulder\"/><joint "
        "name=\"elbow\"/></group>\n"
        "<group_state name=\"left\" group=\"arm\"><joint name=\"shoulder\" value=\"-0.3\"/><joint "
        "name=\"elbow\" value=\"-0.1\"/></group_state>\n"
        "<disable_collisions link1=\"inner\" link2=\"hand\" reason=\"Always\"/>\n"
        "<disable_collisions link1=\"side\" link2=\"hand\" reason=\"Never\"/>\n</robot>\n");
  }

  /// Returns the pairs, except adjacent links, that a robot's file excludes from testing, each with
  /// the reason.
  std::vector<std::string> allowedPairs(const std::string& robot) const {
    std::vector<std::string> pairs;
    const json report = json::parse(run("inspect " + robot + " --json").out);
    for (const json& pair : report["allowed"])
      if (pair["reason"] != "adjacent")
        pairs.push_back(pair["a"].get<std::string>() + ", " + pair["b"].get<std::string>() + ": " +
                        pair["reason"].get<std::string>());
    return pairs;
  }
};

TEST_F(NewCommand, WritesARobotWithItsPairs) {
  const Result result = run("new robot reach.urdf -o reach.yaml");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.out,
            "robot: reach.yaml\n"
            "pairs: 0 adjacent, 1 proved never in contact, 1 in contact in nearly all random "
            "states, 1 others\n"
            "decide: the pairs that are marked DECIDE in the file, or run this with "
            "--allow-overlaps; until then hardly any state is "
            "valid\n");
  const std::string file = read("reach.yaml");
  EXPECT_THAT(file, HasSubstr("format: corridor-robot-1\nname: reach\nurdf: reach.urdf\n"));
  EXPECT_THAT(file, HasSubstr("\nnever_in_contact:\n  # 1 pair proved: "));
  EXPECT_THAT(file, HasSubstr("\n  - [far, hand]\n"));
  EXPECT_THAT(file, testing::ContainsRegex("\n  margin: 0.01\n  beyond_limits: 0.01\n  digest: "
                                           "[0-9a-f]{64}\n  pairs:\n"));
  EXPECT_THAT(file, HasSubstr("\n# DECIDE: 1 pair in contact in at least 95 % of 1,000 random "
                              "states, of which 1 in all."));
  EXPECT_THAT(file, HasSubstr("\n# allow:\n#   - [inner, hand]  # in 1,000 of 1,000\n"));
  EXPECT_THAT(file, testing::ContainsRegex("\n  # - \\[side, hand\\]: in [0-9]+ of 1,000\n"));
  EXPECT_THAT(file, HasSubstr("# - shoulder: revolute, -0.4 to 0.4 rad\n"));
  EXPECT_THAT(file, HasSubstr("# Note: ")) << "the link with a <visual> only";

  // The new file can be read without changes. It excludes the pair that was proved, and no other
  // pair.
  EXPECT_EQ(allowedPairs("reach.yaml"),
            std::vector<std::string>({"far, hand: robot.yaml: never_in_contact"}));
}

/// The user decides by an option, or names the joints.
TEST_F(NewCommand, OptionsReplaceEdits) {
  ASSERT_EQ(run("new robot reach.urdf -o decide.yaml").status, 0);
  EXPECT_EQ(run("new problem decide.yaml -o of_reach.yaml").status, 1) << "no state is valid";
  const Result allowed = run("new robot reach.urdf --allow-overlaps -o allowed.yaml");
  ASSERT_EQ(allowed.status, 0) << allowed.err;
  EXPECT_THAT(allowed.out, HasSubstr("\nallowed: 1 pair in contact in nearly all random states"));
  EXPECT_THAT(read("allowed.yaml"),
              HasSubstr("\nallow:\n  - [inner, hand]  # in 1,000 of 1,000\n"));
  ASSERT_EQ(run("new problem allowed.yaml -o of_reach.yaml --force").status, 0);
  EXPECT_EQ(run("check of_reach.yaml").status, 0);

  ASSERT_EQ(run("new robot reach.urdf --joints elbow -o elbow.yaml").status, 0);
  EXPECT_THAT(run("inspect elbow.yaml").out, HasSubstr("shoulder 0"));
  ASSERT_EQ(
      run("new robot reach.urdf --srdf reach.srdf --joints elbow -o elbow.yaml --force").status, 0);
  EXPECT_THAT(read("elbow.yaml"), HasSubstr("\njoints: [elbow]\n"));
  expectFault(
      "new robot reach.urdf --joints elbow,sholder",
      "--joints: there is no joint \"sholder\" (did you mean \"shoulder\"?) (known: shoulder, "
      "elbow)");
  expectFault("new robot reach.urdf --joints \"to far\"", "--joints: \"to far\" is fixed");
  expectFault("new robot reach.urdf --joints elbow,elbow", "--joints: \"elbow\" is named twice");
}

/// The proved pairs are left out only as long as the robot is the one for which they were proved.
TEST_F(NewCommand, ProvedPairsAreTestedAfterAnEdit) {
  ASSERT_EQ(run("new robot reach.urdf -o reach.yaml").status, 0);
  EXPECT_EQ(allowedPairs("reach.yaml"),
            std::vector<std::string>({"far, hand: robot.yaml: never_in_contact"}));
  const json allowed = json::parse(run("inspect reach.yaml --json").out)["allowed"];
  EXPECT_EQ(allowed.back()["proof"], json({{"margin", 0.01}, {"beyond_limits", 0.01}}));
  EXPECT_THAT(run("inspect reach.yaml").out, Not(HasSubstr("its digest does not match")));
  const std::string urdf = read("reach.urdf");
  std::string edited = urdf;
  edited.replace(edited.find("-3 0 0"), 6, "-2 0 0");
  write("reach.urdf", edited);
  EXPECT_EQ(allowedPairs("reach.yaml"), std::vector<std::string>());
  EXPECT_THAT(run("inspect reach.yaml").out,
              HasSubstr("never_in_contact: its pair is tested, because its digest does not match"));
  ASSERT_EQ(run("new robot reach.urdf -o reach.yaml --force").status, 0);
  EXPECT_THAT(run("inspect reach.yaml").out, Not(HasSubstr("its digest does not match")));
  write("reach.urdf", urdf);
  EXPECT_EQ(allowedPairs("reach.yaml"), std::vector<std::string>());
}

TEST_F(NewCommand, ReadsAnSrdfAndChecksItsPairs) {
  const Result result = run("new robot reach.urdf --srdf reach.srdf -o reach.yaml");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out,
              HasSubstr("pairs: 0 adjacent, 2 by the SRDF, 1 proved never in contact, 0 "
                        "in contact in nearly all random states, 0 others\n"));
  EXPECT_THAT(result.out,
              HasSubstr("check: 1 pair of the SRDF that touched in some random states"));
  const std::string file = read("reach.yaml");
  EXPECT_THAT(file, HasSubstr("\nsrdf: reach.srdf\n"));
  EXPECT_THAT(file, HasSubstr("\ngroup: arm\n"));
  EXPECT_THAT(file, HasSubstr("# - left: {elbow: -0.1, shoulder: -0.3}\n"));
  EXPECT_THAT(file, HasSubstr("# CHECK: the SRDF excludes these pairs"));
  EXPECT_THAT(file, testing::ContainsRegex("# - \\[side, hand\\]: in [0-9]+ of 1,000 \\(SRDF: "
                                           "Never\\)\n"));
  EXPECT_THAT(file, Not(HasSubstr("[inner, hand]"))) << "the SRDF allows it, rightly";
  EXPECT_EQ(allowedPairs("reach.yaml"),
            std::vector<std::string>({"inner, hand: SRDF: Always", "side, hand: SRDF: Never",
                                      "far, hand: robot.yaml: never_in_contact"}));
}

/// The ball `hand` slides along x from 0 to 1.02 m, and turns about its centre. It is in contact
/// with the base up to x = 1 (98 % of all states), with `pin` from x = 0.8 (22 %), with `post` from
/// x = 0.6 (41 %).
TEST_F(NewCommand, SortsPairsByTheirContacts) {
  const auto ball = [](const std::string& name, const std::string& x, const std::string& radius) {
    return "<link name='" + name + "'><collision><origin xyz='" + x +
           " 0 0'/><geometry><sphere radius='" + radius + "'/></geometry></collision></link>";
  };
  const auto joint = [](const std::string& type, const std::string& parent,
                        const std::string& child, const std::string& more) {
    return "<joint name='to " + child + "' type='" + type + "'><parent link='" + parent +
           "'/><child link='" + child + "'/>" + more + "</joint>";
  };
  write("slider.urdf",
        "<robot name='slider'><link name='cart'/>" + ball("base", "0", "0.5") +
            ball("pin", "1.5", "0.2") + ball("post", "1.3", "0.2") + ball("hand", "0", "0.5") +
            joint("fixed", "base", "pin", "") + joint("fixed", "base", "post", "") +
            joint("prismatic", "base", "cart",
                  "<axis xyz='1 0 0'/><limit lower='0' upper='1.02' effort='1' velocity='1'/>") +
            joint("continuous", "cart", "hand", "<axis xyz='0 0 1'/>") + "</robot>");
  const Result result = run("new robot slider.urdf -o slider.yaml");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("1 in contact in nearly all random states, 2 others\n"));
  const std::string file = read("slider.yaml");
  EXPECT_THAT(file, HasSubstr("random states, of which 0 in all."));
  EXPECT_THAT(file, testing::ContainsRegex(
                        "\n# allow:\n#   - \\[base, hand\\]  # in 9[0-9][0-9] of 1,000\n"));
  EXPECT_THAT(file,
              testing::ContainsRegex("  # - \\[post, hand\\]: in [0-9]+ of 1,000\n  # - \\[pin, "
                                     "hand\\]: in [0-9]+ of 1,000\n"));
  EXPECT_THAT(run("new robot slider.urdf --samples 0").out, Not(HasSubstr("[base, hand]:")));
}

TEST_F(NewCommand, SaysHowToChooseAmongManyJoints) {
  const auto chain = [](int joints) {
    std::string text = "<robot name='chain'><link name='l0'/>";
    for (int i = 1; i <= joints; ++i) {
      const std::string link = "l" + std::to_string(i);
      text += "<link name='" + link + "'/><joint name='j" + std::to_string(i) +
              "' type='continuous'><parent link='l" + std::to_string(i - 1) + "'/><child link='" +
              link + "'/><origin xyz='1 0 0'/></joint>";
    }
    return text +
           "<link name='tip'><collision><geometry><sphere radius='0.1'/></geometry>"
           "</collision></link><joint name='to tip' type='fixed'><parent link='l1'/><child "
           "link='tip'/></joint></robot>";
  };
  write("long.urdf", chain(15));
  write("short.urdf", chain(14));
  EXPECT_THAT(run("new robot long.urdf").out,
              HasSubstr("# Without joints, all 15 are planned for"));
  EXPECT_THAT(run("new robot short.urdf").out, Not(HasSubstr("# Without joints, all")));
}

TEST_F(NewCommand, WritesTheSameFileEachTime) {
  const std::string first = run("new robot reach.urdf").out;
  EXPECT_EQ(run("new robot reach.urdf -o -").out, first);
  EXPECT_EQ(run("new robot reach.urdf --seed 1").out, first);
  ASSERT_EQ(run("new robot reach.urdf -o reach.yaml").status, 0);
  EXPECT_EQ(read("reach.yaml"), first);
  EXPECT_EQ(run("new problem reach.urdf --seed 3").out, run("new problem reach.urdf --seed 3").out);
}

TEST_F(NewCommand, ProvesWithTheGivenMarginLimitsAndWork) {
  const auto proves = [&](const std::string& options) {
    return read("out.txt").empty()
               ? false
               : run("new robot reach.urdf " + options).out.find("\n  - [far, hand]\n") !=
                     std::string::npos;
  };
  run("--version");
  EXPECT_TRUE(proves("--margin 1 --beyond-limits 0.1"));
  // The hand is 1.9 m from the shoulder, and far is 3 m from the shoulder. So the centres of hand
  // and far are at most 4.9 m apart.
  EXPECT_FALSE(proves("--margin 4.3"));
  EXPECT_FALSE(proves("--margin 1 --beyond-limits 4")) << "the arm turns right round";
  EXPECT_FALSE(proves("--work 0"));
  EXPECT_FALSE(proves("--work 0 --samples 0"));
  EXPECT_THAT(run("new robot reach.urdf --samples 0").out, Not(HasSubstr("DECIDE")));
}

TEST_F(NewCommand, WritesHowTheUrdfIsRead) {
  std::filesystem::create_directory(folder_ / "parts");
  const Result result =
      run("new robot reach.urdf --visuals collide --limits soft --collada-up file --package "
          "parts=parts -o reach.yaml");
  ASSERT_EQ(result.status, 0) << result.err;
  const std::string file = read("reach.yaml");
  for (const char* line : {"\nvisuals: collide  #", "\nlimits: soft  #", "\ncollada_up: file  #",
                           "\npackages: {parts: parts}\n"})
    EXPECT_THAT(file, HasSubstr(line));
  EXPECT_EQ(run("inspect reach.yaml").status, 0);
}

/// File names in the new file are relative to its folder.
TEST_F(NewCommand, NamesFilesFromTheNewFilesFolder) {
  std::filesystem::create_directory(folder_ / "robots");
  ASSERT_EQ(run("new robot reach.urdf --srdf reach.srdf -o robots/robot.yaml").status, 0);
  EXPECT_THAT(read("robots/robot.yaml"), HasSubstr("urdf: ../reach.urdf\nsrdf: ../reach.srdf\n"));
  EXPECT_EQ(run("inspect robots").status, 0);
  ASSERT_EQ(run("new problem robots -o problem2.yaml").status, 0);
  EXPECT_THAT(read("problem2.yaml"), HasSubstr("robot: robots/robot.yaml\n"));
  // A symbolic link is replaced by the new file, so names are relative to the folder of the
  // symbolic link.
  std::filesystem::create_symlink("robots/robot.yaml", folder_ / "link.yaml");
  ASSERT_EQ(run("new robot reach.urdf --srdf reach.srdf -o link.yaml --force").status, 0);
  EXPECT_EQ(run("inspect link.yaml").status, 0);
}

TEST_F(NewCommand, WritesAProblemThatCanBeSolved) {
  // The robot has named states, so the problem uses their names.
  write("arm-robot.yaml",
        "format: corridor-robot-1\nurdf: arm.urdf\nstates:\n  a: {shoulder: 0, elbow: 0}\n  b: "
        "{shoulder: 1, elbow: 1}\n");
  Result result = run("new problem arm-robot.yaml -o named.yaml");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.out,
            "problem: named.yaml\nstart: a named state of the robot\ngoal: a named state of the "
            "robot\n");
  EXPECT_THAT(read("named.yaml"), HasSubstr("\nstart: a\n"));
  EXPECT_THAT(read("named.yaml"), HasSubstr("\ngoal: b\n"));
  // The robot has no named states.
  ASSERT_EQ(run("new problem reach.urdf -o x.yaml").status, 1);
  EXPECT_THAT(read("x.yaml"), HasSubstr("# NOT VALID: "));
  const std::string why =
      "most often in contact, in 1,002 tried states: \\[inner, hand\\] in 100 %, \\[side, hand\\] "
      "in [0-9]+ %";
  EXPECT_THAT(read("out.txt"), testing::ContainsRegex("why: " + why + "; allow the pairs "));
  EXPECT_THAT(read("x.yaml"), HasSubstr("# Why: most often in contact, in 1,002 tried states: "
                                        "[inner, hand] in 100 %"));
  ASSERT_EQ(run("new robot reach.urdf --srdf reach.srdf -o reach.yaml").status, 0);
  ASSERT_EQ(run("new problem reach.yaml -o one.yaml").status, 0);
  EXPECT_THAT(read("one.yaml"), HasSubstr("\nstart: left\n"));
  ASSERT_EQ(run("new problem arm.urdf -o none.yaml").status, 0);
  EXPECT_THAT(read("none.yaml"), HasSubstr("# every joint at 0, or at the limit nearest to 0\n"));
  for (const char* problem : {"named.yaml", "one.yaml", "none.yaml"}) {
    EXPECT_EQ(run("check " + std::string(problem)).status, 0) << problem;
    result = run("solve " + std::string(problem) + " -o s.yaml");
    EXPECT_EQ(result.status, 0) << problem << result.out << result.err;
    EXPECT_EQ(run("verify " + std::string(problem) + " s.yaml").status, 0) << problem;
  }
}

TEST_F(NewCommand, NotesWhatANewProblemDoesNotTest) {
  write("seen.urdf",
        "<robot name='seen'><link name='a'><collision><geometry><sphere radius='1'/></geometry>"
        "</collision></link><link name='b'><visual><geometry><sphere radius='1'/></geometry>"
        "</visual></link><joint name='j' type='prismatic'><parent link='a'/><child link='b'/>"
        "<axis xyz='1 0 0'/><limit lower='0' upper='1' effort='1' velocity='1'/></joint></robot>");
  const Result result = run("new problem seen.urdf -o seen.yaml");
  EXPECT_EQ(result.status, 0);
  EXPECT_THAT(result.err, HasSubstr("note: seen.urdf:1: 1 link is not tested, having a <visual>"));
}

TEST_F(NewCommand, WritesProblemsOfBodiesThatMoveAsAWhole) {
  write(
      "cart.urdf",
      "<robot name='cart'><link name='world'/><link name='cart'><collision><geometry><box size='1 "
      "1 1'/></geometry></collision></link><joint name='drive' type='planar'><parent "
      "link='world'/><child link='cart'/><axis xyz='0 0 1'/></joint></robot>");
  write("flyer.urdf",
        "<robot name='flyer'><link name='world'/><link name='body'><collision><geometry><box "
        "size='1 1 1'/></geometry></collision></link><joint name='fly' type='floating'><parent "
        "link='world'/><child link='body'/></joint></robot>");
  write("plane.yaml",
        "format: corridor-robot-1\nname: cube\nrigid: SE2\nshapes: [{box: [0.2, 0.2, 0.2]}]\n");
  for (const char* robot : {"robot.yaml", "plane.yaml", "cart.urdf", "flyer.urdf"}) {
    const Result result = run("new problem " + std::string(robot) + " -o p.yaml --force");
    ASSERT_EQ(result.status, 0) << robot << result.err;
    const Result solved = run("solve p.yaml -o s.yaml");
    EXPECT_EQ(solved.status, 0) << robot << solved.out << solved.err << read("p.yaml");
  }
}

TEST_F(NewCommand, ReplacesNoFile) {
  write("robot2.yaml", "mine\n");
  expectFault("new robot reach.urdf -o robot2.yaml",
              "--output: robot2.yaml exists; name another file, or replace it by --force");
  expectFault("new problem reach.urdf -o robot2.yaml",
              "--output: robot2.yaml exists; name another file, or replace it by --force");
  EXPECT_EQ(read("robot2.yaml"), "mine\n");
  EXPECT_EQ(run("new robot reach.urdf -o robot2.yaml --force").status, 0);
  EXPECT_THAT(read("robot2.yaml"), HasSubstr("format: corridor-robot-1"));
  expectFault("new robot reach.urdf -o reach.urdf --force",
              "--output: reach.urdf belongs to the robot and would be overwritten; name another "
              "file");
  expectFault("new problem reach.urdf -o reach.urdf --force",
              "--output: reach.urdf belongs to the robot and would be overwritten; name another "
              "file");
}

TEST_F(NewCommand, BadInputIsOneLineAndExit2) {
  expectFault("new", "A subcommand is required; see corridor new --help");
  expectFault("new robt reach.urdf",
              "unknown command \"robt\" (did you mean \"robot\"?); there are: robot, problem; see "
              "corridor new --help");
  expectFault("new robot", "URDF is required; see corridor new robot --help");
  expectFault(
      "new robot reach.urdf --sdrf x",
      "unknown option \"--sdrf\" (did you mean \"--srdf\"?); see corridor new robot --help");
  expectFault("new robot reach.urdf -o ''", "--output: is empty; see corridor new robot --help");
  expectFault("new robot none.urdf", "none.urdf: no such file");
  expectFault("new robot reach.urdf --srdf none.srdf", "none.srdf: no such file");
  expectFault("new robot reach.urdf --package a", "--package: NAME=FOLDER is needed, not \"a\"");
  expectFault("new robot reach.urdf --package a=none", "--package: none: no such folder");
  expectFault("new robot reach.urdf --margin -1",
              "--margin: a number from 0 to 1000000 is needed, not \"-1\"; see corridor new robot "
              "--help");
  expectFault("new robot reach.urdf -o none/robot.yaml", "--output: there is no folder none");
  expectFault("new problem none.yaml", "none.yaml: no such file");
  write("robot.yaml", "format: corridor-robot-1\n");
  for (const std::string robot : {"robot.yaml", "."})
    expectFault(
        "new robot " + robot,
        robot + ": a URDF is needed; corridor new problem takes a robot.yaml or its folder");
  write("still.urdf", "<robot name='still'><link name='a'/></robot>");
  expectFault(
      "new robot still.urdf",
      "still.urdf: has no joint that can be planned for; for a vehicle, add a planar or floating "
      "joint on an empty link to the URDF, or use rigid: SE3 in a robot.yaml");
}

}  // namespace
