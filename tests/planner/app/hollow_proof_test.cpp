// Tests of proofs that would mislead: of a problem in which no pair of bodies is tested, and of a
// path that was made for another problem. Each command warns of them before any other output.
#include <map>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/planner/app/program_test.h"

namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::StartsWith;

const std::string kNothing =
    "no pair of bodies is tested, so nothing can collide and every state counts as free; corridor "
    "inspect --pairs lists the reasons";

class HollowProof : public corridor::test::ProgramTest {
 protected:
  HollowProof() {
    write("robot.yaml",
          "format: corridor-robot-1\nname: cube\nrigid: SE2\nshapes: [{box: [0.2, 0.2, 0.2]}]\n");
    write("hall.yaml", hall(""));
    write("allowed.yaml", hall("allow: [[cube, wall]]\n"));
    write(
        "arm.urdf",
        "<robot name='arm'><link name='a'/><link name='b'><collision><geometry><box size='1 1 1'/>"
        "</geometry></collision></link><joint name='pan' type='continuous'><parent link='a'/>"
        "<child link='b'/><axis xyz='0 0 1'/></joint></robot>");
    write("alone.yaml",
          "format: corridor-problem-1\nrobot: arm.urdf\nworld: {}\nstart: {pan: 0}\ngoal: {pan: "
          "1}\n");
    write("through.yaml",
          "format: corridor-solution-1\nspace: SE2\npath: [[-2, 0, 0], [2, 0, 0]]\n");
    write("turn.yaml", "format: corridor-solution-1\njoints: [pan]\npath: [[0], [1]]\n");
    write("states.txt", "0\n1\n");
  }

  static std::string hall(const std::string& more) {
    return "format: corridor-problem-1\nrobot: robot.yaml\nworld:\n  wall: {box: [0.1, 2, 1]}\n"
           "start: {at: [-2, 0]}\ngoal: {at: [2, 0]}\nbounds: {at: [[-4, -4], [4, 4]]}\n" +
           more;
  }
};

/// Covers all commands of --help: a new command that takes a problem fails here until it is added.
TEST_F(HollowProof, EveryCommandSaysFirstThatNothingIsTested) {
  const std::map<std::string, std::vector<std::string>> uses = {
      {"solve", {"solve alone.yaml", "solve alone.yaml --json"}},
      {"verify", {"verify alone.yaml turn.yaml", "verify alone.yaml turn.yaml --json"}},
      {"view", {"view alone.yaml -o page.html", "view alone.yaml turn.yaml -o page.html"}},
      {"benchmark", {"benchmark alone.yaml --runs 1", "benchmark alone.yaml --runs 1 --json"}},
      {"check",
       {"check alone.yaml", "check alone.yaml --json", "check alone.yaml --states states.txt",
        "check alone.yaml --states states.txt --json"}},
      {"inspect", {"inspect alone.yaml", "inspect alone.yaml --json"}},
      {"query", {}},  // takes two meshes, no problem
  };
  for (const std::string& command : commands()) EXPECT_EQ(uses.count(command), 1u) << command;
  for (const auto& [command, all] : uses)
    for (const std::string& arguments : all) {
      // stdout is buffered, so one file for both streams would not show which output came first.
      // The test reads the first line of stderr and, with --json, the first of the notes on stdout.
      const Result result = run(arguments);
      EXPECT_EQ(result.status, 0) << arguments << ": " << result.err;
      const std::string name = command == "benchmark" ? "alone" : "alone.yaml";
      EXPECT_EQ(lines(result.err).at(0), "corridor: warning: " + name + ": " + kNothing)
          << arguments;
      if (arguments.find("--json") == std::string::npos) continue;
      json report = json::parse(result.out);
      if (command == "solve") report = report["problems"][0];
      EXPECT_EQ(report["notes"][0], (command == "benchmark" ? "alone: " : "") + kNothing)
          << arguments;
    }
  EXPECT_THAT(read("page.html"), HasSubstr("\"notes\":[\"" + kNothing));
}

TEST_F(HollowProof, AClearanceOfNothingIsNoNumber) {
  const Result text = run("verify alone.yaml turn.yaml");
  EXPECT_THAT(text.out, HasSubstr("clearance: none: no pair is tested\n"));
  EXPECT_THAT(text.out, HasSubstr("note: " + kNothing));
  EXPECT_EQ(text.out.find("inf"), std::string::npos) << text.out;
  const json report = json::parse(run("verify alone.yaml turn.yaml --json").out);
  EXPECT_EQ(report["proven_clearance_m"], nullptr);
  EXPECT_EQ(report["smallest_distance_met_m"], nullptr);
  const json campaign = json::parse(run("benchmark alone.yaml --runs 1 --json").out);
  EXPECT_EQ(campaign["results"][0]["rows"][0]["proven_clearance_m"], nullptr);
}

/// The reason does not matter: here an `allow` excludes the only pair.
TEST_F(HollowProof, AllPairsAllowedIsNothingTested) {
  const Result result = run("verify allowed.yaml through.yaml");
  EXPECT_EQ(result.err, "corridor: warning: allowed.yaml: " + kNothing + "\n");
  EXPECT_EQ(run("verify hall.yaml through.yaml").err, "");
}

class OtherProblem : public HollowProof {
 protected:
  OtherProblem() {
    write("there.yaml", hall("seed: 2\n"));
    write("s.yaml", solution(digestOf("there.yaml")));
    write("own.yaml", solution(digestOf("hall.yaml")));
    write("by_hand.yaml", solution(""));
    write("states.path", "-2 0 0\n-2 3 0\n2 3 0\n2 0 0\n");
  }
  std::string digestOf(const std::string& problem) const {
    return json::parse(run("inspect " + problem + " --json").out)["digest"];
  }
  static std::string solution(const std::string& digest) {
    return "format: corridor-solution-1\n" + (digest.empty() ? "" : "digest: " + digest + "\n") +
           "space: SE2\npath: [[-2, 0, 0], [-2, 3, 0], [2, 3, 0], [2, 0, 0]]\n";
  }
};

TEST_F(OtherProblem, IsNotProved) {
  const std::string warning =
      "corridor: warning: s.yaml: made for other files than those of hall.yaml (the digests "
      "differ)";
  const Result refused = run("verify hall.yaml s.yaml");
  EXPECT_EQ(refused.status, 1);
  EXPECT_EQ(refused.out, "problem: hall.yaml\nsolution: s.yaml\nverdict: other problem\n");
  EXPECT_EQ(refused.err, warning + "; it is not verified: --ignore-digest verifies it anyway\n");
  const Result asJson = run("verify hall.yaml s.yaml --json");
  EXPECT_EQ(asJson.status, 1);
  const json report = json::parse(asJson.out);
  EXPECT_EQ(report["format"], "corridor-verify-report-3");
  EXPECT_EQ(report["verdict"], "other problem");
  EXPECT_EQ(report["digest"], "differs");
  EXPECT_EQ(report["edges_proved"], 0);
  EXPECT_EQ(report["edges"], 3);
  EXPECT_EQ(run("verify hall.yaml s.yaml --quiet").status, 1);

  const Result ignored = run("verify hall.yaml s.yaml --ignore-digest");
  EXPECT_EQ(ignored.status, 0) << ignored.out;
  EXPECT_THAT(ignored.out, HasSubstr("verdict: proved\n"));
  EXPECT_EQ(ignored.err, warning + "\n");
  const json ignoredReport = json::parse(run("verify hall.yaml s.yaml --ignore-digest --json").out);
  EXPECT_EQ(ignoredReport["verdict"], "proved");
  EXPECT_EQ(ignoredReport["digest"], "differs");
}

TEST_F(OtherProblem, SameAndNoDigestAreVerified) {
  for (const auto& [file, digest] : std::map<std::string, std::string>{
           {"own.yaml", "same"}, {"by_hand.yaml", "none"}, {"states.path", "none"}}) {
    const Result result = run("verify hall.yaml " + file + " --json");
    EXPECT_EQ(result.status, 0) << file;
    EXPECT_EQ(result.err, "") << file;
    const json report = json::parse(result.out);
    EXPECT_EQ(report["verdict"], "proved") << file;
    EXPECT_EQ(report["digest"], digest) << file;
  }
}

/// A solution of `solve` verifies until one of the problem's files changes.
TEST_F(OtherProblem, IsAProblemWhoseFilesHaveChanged) {
  ASSERT_EQ(run("solve hall.yaml -o path.yaml").status, 0);
  EXPECT_EQ(run("verify hall.yaml path.yaml").status, 0);
  write("robot.yaml",
        "format: corridor-robot-1\nname: cube\nrigid: SE2\nshapes: [{box: [0.1, 0.1, 0.1]}]\n");
  EXPECT_EQ(run("verify hall.yaml path.yaml").status, 1);
}

}  // namespace
