// Tests of problems in which no pair of bodies is tested. A proof for such a problem would mislead,
// so each command that reads a problem warns before any other output.
#include <map>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/planner/app/program_fixtures.h"

namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::string kNothing =
    "no pair of bodies is tested, so nothing can collide and every state counts as free; corridor "
    "inspect --pairs lists the reasons";

class NothingTested : public corridor::test::HallTest {
 protected:
  NothingTested() {
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
};

/// Covers all commands that --help lists: the test fails for a new command until it is added here.
TEST_F(NothingTested, EveryCommandWarnsFirst) {
  const std::map<std::string, std::vector<std::string>> uses = {
      {"solve", {"solve alone.yaml", "solve alone.yaml --json"}},
      {"verify", {"verify alone.yaml turn.yaml", "verify alone.yaml turn.yaml --json"}},
      {"view", {"view alone.yaml -o page.html", "view alone.yaml turn.yaml -o page.html"}},
      {"benchmark", {"benchmark alone.yaml --runs 1", "benchmark alone.yaml --runs 1 --json"}},
      {"check",
       {"check alone.yaml", "check alone.yaml --json", "check alone.yaml --states states.txt",
        "check alone.yaml --states states.txt --json"}},
      {"inspect", {"inspect alone.yaml", "inspect alone.yaml --json"}},
      {"query", {}},   // takes two meshes, no problem
      {"course", {}},  // takes no problem, either
      {"cache", {}},   // fills a cache, and answers nothing about a problem
      {"pose", {}},    // takes a robot, no problem
      {"new", {}},     // takes a robot, no problem
  };
  for (const std::string& command : commands()) EXPECT_EQ(uses.count(command), 1u) << command;
  for (const auto& [command, all] : uses)
    for (const std::string& arguments : all) {
      // stdout is buffered, so one file for both streams would not show which output came first.
      // The test reads the first line of stderr and, with --json, the first entry of `notes` on
      // stdout.
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

TEST_F(NothingTested, ClearanceIsNotPrintedAsANumber) {
  const Result text = run("verify alone.yaml turn.yaml");
  EXPECT_THAT(text.out, HasSubstr("clearance: none: no pair is tested\n"));
  EXPECT_THAT(text.out, HasSubstr("note: " + kNothing));
  EXPECT_EQ(text.out.find("inf"), std::string::npos) << text.out;
  const json report = json::parse(run("verify alone.yaml turn.yaml --json").out);
  EXPECT_EQ(report["proved_clearance_m"], nullptr);
  EXPECT_EQ(report["closest_found_m"], nullptr);
  const json campaign = json::parse(run("benchmark alone.yaml --runs 1 --json").out);
  EXPECT_EQ(campaign["results"][0]["rows"][0]["proved_clearance_m"], nullptr);
}

/// It does not matter why no pair is tested: here an `allow` excludes the only pair.
TEST_F(NothingTested, WarnsIfAllPairsAreAllowed) {
  const Result result = run("verify allowed.yaml through.yaml");
  EXPECT_EQ(result.err, "corridor: warning: allowed.yaml: " + kNothing + "\n");
  EXPECT_EQ(run("verify hall.yaml through.yaml").err, "");
}

}  // namespace
