// Tests of solutions that were made for another problem, or whose problem's files have changed
// since: the digests differ, so the solutions are not verified.
#include <map>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/planner/app/program_fixtures.h"

namespace {

using nlohmann::json;
using testing::HasSubstr;

class OtherProblem : public corridor::test::HallTest {
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
  EXPECT_EQ(report["format"], "corridor-verify-report-4");
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

/// The proof is for the margin and tube of the problem, whatever margin and tube the solution
/// claims.
TEST_F(OtherProblem, LargerClaimsOfTheSolutionAreNoted) {
  write("bold.yaml", solution("") + "margin: 0.5\ntube: {position: 0.5, rotation: 0.1}\n");
  const Result bold = run("verify hall.yaml bold.yaml");
  EXPECT_EQ(bold.status, 0);
  EXPECT_EQ(bold.err,
            "corridor: warning: bold.yaml: it claims a margin of 0.5 m; it is verified with the "
            "problem's, 0 m\n"
            "corridor: warning: bold.yaml: it claims a larger tube than the problem's; it is "
            "verified with the problem's\n");
  const json warnings = json::parse(run("verify hall.yaml bold.yaml --json").out)["warnings"];
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_EQ(warnings[0],
            "bold.yaml: it claims a margin of 0.5 m; it is verified with the "
            "problem's, 0 m");
  EXPECT_EQ(json::parse(run("verify hall.yaml s.yaml --json").out)["warnings"].size(), 1u);
}

TEST_F(OtherProblem, SameDigestOrNoDigestIsVerified) {
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
TEST_F(OtherProblem, ChangedFilesMakeAnotherProblem) {
  ASSERT_EQ(run("solve hall.yaml -o path.yaml").status, 0);
  EXPECT_EQ(run("verify hall.yaml path.yaml").status, 0);
  write("robot.yaml",
        "format: corridor-robot-1\nname: cube\nrigid: SE2\nshapes: [{box: [0.1, 0.1, 0.1]}]\n");
  EXPECT_EQ(run("verify hall.yaml path.yaml").status, 1);
}

}  // namespace
